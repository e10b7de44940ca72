/// A device at work: loop, thread, and the file that records it. What a player needs of this library.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/api.h"
#include "core/wrench_timeline.h"
#include "spidar/device.h"
#include "spidar/haptic_loop.h"
#include "spidar/playback_clock.h"
#include "spidar/profile.h"
#include "spidar/safety.h"

namespace spidar {

struct SessionSettings {
  SafetyLimits limits;
  std::string trace_path;  ///< CSV, one row a tick; empty: none
  bool threaded = true;    ///< false: the owner calls tick()
};

/// Whether the loop's thread runs with real-time priority, and if not, why.
struct Scheduling {
  bool real_time = false;
  std::string detail;  ///< "SCHED_FIFO 80" or the reason and what would help
};

class SPIDAR_API HapticSession {
 public:
  /// Opens the device and starts the loop. Throws DeviceError, or std::runtime_error when the trace
  /// cannot be written.
  HapticSession(const Profile& profile, std::unique_ptr<Device> device,
                const SessionSettings& settings);
  /// Ramps to rest, then to zero, and closes the device.
  ~HapticSession();

  HapticLoop& loop() noexcept;
  const HapticLoop& loop() const noexcept;
  Device& device() noexcept;
  const Scheduling& scheduling() const noexcept;

  /// CLOCK_MONOTONIC, nanoseconds.
  static int64_t monotonic_now_ns() noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spidar
