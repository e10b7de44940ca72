// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A process that takes the motors to zero when this one cannot.
#pragma once

#include <cstdint>
#include <string>
#include <sys/types.h>

#include "core/api.h"
#include "spidar/guardian/last_will.h"

namespace spidar {

/// Boards keep their last value when the host goes silent, and nothing in a process runs when it is
/// killed or stopped. A guardian is a small program of its own (spidar-guardian), with the device's
/// open file and packets of zeros at hand. It sends them when this process ends, whoever else has
/// inherited its files, and when motors pull and watch() was not called for kSilence_ms.
///
/// One thread at a time. In a forked child of the process that made it, it does nothing.
class SPIDAR_API Guardian {
 public:
  /// Starts one for the connection. Throws DeviceError when the program is not found or does not
  /// answer. The program is $SPIDAR_GUARDIAN, or the installed one.
  Guardian(const std::string& device, const LastWill& will);
  /// Sends it away; its will is not carried out.
  ~Guardian();
  Guardian(const Guardian&) = delete;
  Guardian& operator=(const Guardian&) = delete;

  /// To be called in every exchange: `pulling` as long as the motors are not at zero, from before
  /// the first volt to after the last. False when it guards no more: it was killed, has been
  /// stopped for kAnswer_ns, or has carried out its will because this process was silent. Then the
  /// motors are to be taken to zero, and another guardian is needed.
  bool watch(bool pulling) noexcept;

  /// Its will is carried out now: when the board is released but the motors could not be zeroed.
  void carry_out() noexcept;

  /// A busy machine may let a process wait for long; a guardian that is stopped is only missed when
  /// its host fails, too.
  static constexpr int64_t kAnswer_ns = 500'000'000;

 private:
  bool say(HostWord word) noexcept;
  void finish() noexcept;

  int socket_ = -1;
  pid_t process_ = -1;
  pid_t owner_ = -1;
  bool pulling_ = false;  // as the guardian knows it
  bool zeroed_ = false;   // the motors, by the guardian
  int64_t said_ns_ = 0;
  int64_t unanswered_ns_ = 0;  // since when; 0: all is answered
};

}  // namespace spidar
