// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <sys/types.h>
#include <vector>

namespace spidar {

/// Packets for one connection that set its motors to zero. A plain structure, because it is sent
/// through a socket to another program, together with the device's file.
struct LastWill {
  enum class Wire : uint32_t {
    kUsb,       ///< usbfs: bulk or interrupt packets to one endpoint
    kTerminal,  ///< a tty, to which packets are written
    kInput,     ///< an input device: each packet is an InputEvent
    kSocket,    ///< a stream socket, to which packets are written
  };
  /// An event of the type EV_FF. The guardian converts the event to the kernel's structure, whose
  /// size differs between 32-bit and 64-bit programs, because a host and its guardian may differ in
  /// that (Multi-Arch).
  struct InputEvent {
    uint32_t code = 0;
    int32_t value = 0;
  };
  static constexpr size_t kMaxPackets = 8;  // a line has up to eight UART boards
  static constexpr size_t kMaxLength = 512;
  static constexpr size_t kMaxSettings = 24;
  static constexpr uint32_t kMagic = 0x53504736;  // "SPG6": this layout

  uint32_t magic = kMagic;
  Wire wire = Wire::kUsb;
  uint32_t interface_number = 0;
  uint32_t endpoint = 0;
  uint32_t packets = 0;
  uint32_t settings = 0;
  std::array<uint32_t, kMaxPackets> length{};
  std::array<std::array<uint8_t, kMaxLength>, kMaxPackets> packet{};
  /// For an input device: the events that restore its settings from before it was driven, one every
  /// kSetting_ms. The guardian sends them last if the host has ended and the motors had pulled.
  std::array<InputEvent, kMaxSettings> setting{};
  /// The device's file, open, and claimed or locked. The guardian receives a descriptor of the same
  /// open file, so that the host's claim is also valid for the guardian. The descriptor has a
  /// different number in each process.
  int file = -1;
};
static_assert(sizeof(LastWill) == 7 * 4 + LastWill::kMaxPackets * (4 + LastWill::kMaxLength) +
                                      LastWill::kMaxSettings * 8,
              "the layout must be the same in 32-bit and 64-bit programs");

/// A host that exchanges with its board sends a heartbeat at least every kBeat_ms. If its motors
/// pull and no heartbeat arrives for kSilence_ms, the host stands still: a signal or a debugger has
/// stopped it, it has a fault of its own, or it gets no processor. The guardian then sets the
/// motors to zero. A host that finds its own clock so late does the same, because the cause may
/// have stopped the guardian as well. If the host runs and gets no answer for kAnswer_ms, its
/// guardian is dead or stopped. So when a guardian stops, motors that pull are at zero after
/// kAnswer_ms if the host runs all the time, after kAnswer_ms + kSilence_ms if the host runs every
/// kSilence_ms, and otherwise when the host runs again.
constexpr int kBeat_ms = 10;
constexpr int kSetting_ms = 5;
/// The duration of an input device's effects, which must not outlast a hanging or stopped program.
constexpr int kEffect_ms = 150;
constexpr int kSilence_ms = 50;
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int kAnswer_ms = 800;  // under a sanitizer, programs are up to ten times slower
#else
constexpr int kAnswer_ms = 80;
#endif

/// Messages from a host to its guardian, one byte each. The guardian answers every message except
/// kDismissed; the answers show the host that its guardian is running.
enum class HostHeartbeat : char {
  kPulling = 'p',    ///< the motors pull: the next message must follow soon
  kResting = 'r',    ///< the motors are at zero: the host may be silent
  kDismissed = 'q',  ///< the guardian must end without sending the packets
};

/// Answers of the guardian; the first one says that the guardian is ready.
enum class GuardianAnswer : char {
  kWatching = 'w',
  /// The host sent no message in time, and the guardian has sent the zeros. The guardian repeats
  /// them every kSilence_ms, or sooner if they have not arrived, until the host dismisses it,
  /// because a host that continues may send old volts before reading this answer.
  kZeroed = 'z',
};

/// The separate process that sets motors to zero when this one cannot. Boards keep their last value
/// when the host stops sending, and no code of a process runs after it is killed or while it is
/// stopped. A guardian is a small program (spidar-guardian) that has the device's open file and
/// packets of zeros. It sends these packets when this process ends, even if another process has
/// inherited its files, and when motors pull and watch() was not called for kSilence_ms. When this
/// process has ended, the guardian also restores the settings of an input device.
///
/// One thread at a time. In a forked child, this object does nothing.
class Guardian {
 public:
  /// Starts a guardian for the connection. Throws DeviceError when the program is not found or does
  /// not answer. The program is $SPIDAR_GUARDIAN, or the installed one. It has a session of its own
  /// and, where systemd runs, a scope of its own, so that the guardian survives what ends or
  /// freezes the control group of this process. If $SPIDAR_GUARDIAN is a socket (SOCK_SEQPACKET), a
  /// service behind the socket starts the guardian.
  Guardian(const std::string& device, const LastWill& will);
  /// Dismisses the guardian, which then does not send the packets of `will`.
  ~Guardian();
  Guardian(const Guardian&) = delete;
  Guardian& operator=(const Guardian&) = delete;

  /// Call this in every exchange. `pulling` must be true as long as the motors are not at zero,
  /// from before the first voltage to after the last. Returns false if the guardian no longer
  /// works, because it was killed or has been silent for kAnswer_ms, or if this process
  /// was_suspended(). The caller must then set the motors to zero and create another guardian.
  bool watch(bool pulling) noexcept;

  /// Whether this process did not call watch() for kSilence_ms while the motors pulled.
  bool was_suspended() const noexcept { return was_suspended_; }

  /// Makes the guardian set the motors to zero now, for the case that the board is released but the
  /// motors could not be set to zero. Returns after kEnd_s at the latest; the guardian goes on
  /// trying until the board takes the zeros or is gone. The effects of an input device end by
  /// themselves, and the kernel erases them when the device is closed.
  void carry_out() noexcept;

  static constexpr int kEnd_s = 2;

 private:
  enum class End { kWait, kLeave };

  bool start(const std::vector<std::string>& command, const LastWill& will, int timeout_s);
  bool greet(const LastWill& will, int timeout_s);
  bool connect_to(const std::string& path);
  bool send_heartbeat(HostHeartbeat heartbeat) noexcept;
  void send_signal(int number) const noexcept;
  void finish(End end) noexcept;

  int socket_ = -1;
  pid_t process_ = -1;  ///< −1: the guardian is a service
  pid_t owner_ = -1;
  bool pulling_ = false;  ///< as last reported to the guardian
  bool was_suspended_ = false;
  int64_t sent_ns_ = 0;
  int64_t watched_ns_ = 0;
  int64_t silent_ns_ = 0;  ///< time since the last proof that the guardian works
};

}  // namespace spidar
