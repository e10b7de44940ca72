// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A separate process that sets the motors to zero when this one cannot.
#pragma once

#include <cstdint>
#include <string>
#include <sys/types.h>
#include <vector>

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
class Guardian {
 public:
  /// Starts a guardian for the connection. Throws DeviceError when the program is not found or does
  /// not answer. The program is $SPIDAR_GUARDIAN, or the installed one. It has a session of its
  /// own, and where systemd runs a scope of its own, so that it survives what ends or freezes the
  /// control group of this process. If $SPIDAR_GUARDIAN is a socket (SOCK_SEQPACKET), a service
  /// behind it starts the guardian.
  Guardian(const std::string& device, const LastWill& will);
  /// Dismisses the guardian; it does not send the packets of `will`.
  ~Guardian();
  Guardian(const Guardian&) = delete;
  Guardian& operator=(const Guardian&) = delete;

  /// To be called in every exchange. `pulling` must be true as long as the motors are not at zero,
  /// from before the first voltage to after the last. Returns false if the guardian no longer
  /// works: it was killed, has not answered for kAnswer_ms, or has zeroed the motors because this
  /// process did not call watch() in time. The caller must then set the motors to zero and create
  /// another guardian.
  bool watch(bool pulling) noexcept;

  /// The guardian has zeroed the motors because this process did not call watch() in time.
  bool zeroed() const noexcept { return zeroed_; }

  /// Makes the guardian zero the motors now, for the case that the board is released but the motors
  /// could not be zeroed. Returns after kEnd_s at the latest; the guardian goes on trying until the
  /// board takes the zeros or is gone.
  void carry_out() noexcept;

  static constexpr int kEnd_s = 2;

 private:
  enum class End { kWait, kLeave };

  bool start(const std::vector<std::string>& command, const LastWill& will, int patience_s);
  bool greet(const LastWill& will, int patience_s);
  bool connect_to(const std::string& path);
  bool say(HostWord word) noexcept;
  void send_signal(int number) const noexcept;
  void finish(End end) noexcept;

  int socket_ = -1;
  pid_t process_ = -1;  // −1: it is a service
  pid_t owner_ = -1;
  bool pulling_ = false;  // as the guardian knows it
  bool zeroed_ = false;   // the motors, by the guardian
  int64_t said_ns_ = 0;
  int64_t unanswered_ns_ = 0;  // since when; 0: all is answered
};

}  // namespace spidar
