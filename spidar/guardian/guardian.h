// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A separate process that sets the motors to zero when this one cannot.
#pragma once

#include <cstdint>
#include <string>
#include <sys/types.h>

#include "core/api.h"
#include "spidar/guardian/last_will.h"

namespace spidar {

/// Boards keep their last value when the host stops sending, and no code of a process runs after it
/// is killed or while it is stopped. A guardian is a small separate program (spidar-guardian) that
/// has the device's open file and packets of zeros. It sends these packets when this process ends,
/// even if another process has inherited its files, and when motors pull and watch() was not called
/// for kSilence_ms.
///
/// To be used by one thread at a time. In a forked child of the process that created it, it does
/// nothing.
class SPIDAR_API Guardian {
 public:
  /// Starts a guardian for the connection. Throws DeviceError when the program is not found or does
  /// not answer. The program is $SPIDAR_GUARDIAN, or the installed one.
  Guardian(const std::string& device, const LastWill& will);
  /// Dismisses the guardian; it does not send the packets of `will`.
  ~Guardian();
  Guardian(const Guardian&) = delete;
  Guardian& operator=(const Guardian&) = delete;

  /// To be called in every exchange. `pulling` must be true as long as the motors are not at zero,
  /// from before the first voltage to after the last. Returns false if the guardian no longer
  /// works: it was killed, has been stopped for kAnswer_ns, or has zeroed the motors because this
  /// process did not call watch() in time. The caller must then set the motors to zero and create
  /// another guardian.
  bool watch(bool pulling) noexcept;

  /// The guardian has zeroed the motors because this process did not call watch() in time.
  bool zeroed() const noexcept { return zeroed_; }

  /// Makes the guardian zero the motors now, for the case that the board is released but the motors
  /// could not be zeroed.
  void carry_out() noexcept;

  /// This time is long because a process may have to wait on a busy machine, and a stopped guardian
  /// is only a problem if its host fails, too.
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
