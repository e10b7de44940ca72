// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A device at work: loop, thread, and the file that records it. What a player needs of this
/// library.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/api.h"
#include "core/force/wrench_timeline.h"
#include "spidar/device.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/loop/playback_clock.h"
#include "spidar/loop/safety.h"
#include "spidar/loop/tick_trace.h"
#include "spidar/profiles/profile.h"
#include "spidar/realtime/scheduling.h"

namespace spidar {

struct SessionSettings {
  SafetyLimits limits;
  std::string trace_path;  ///< CSV, one row a tick; empty: none
  bool threaded = true;    ///< false: the owner calls loop().tick()
  bool real_time = true;   ///< ask for real-time priority; works without
};

class SPIDAR_API HapticSession {
 public:
  /// Opens the device and starts the loop. Throws DeviceError, std::invalid_argument when the
  /// profile has fewer than six strings, or TraceError when the trace cannot be written.
  HapticSession(const Profile& profile, std::unique_ptr<Device> device,
                const SessionSettings& settings = {});
  /// Ramps to rest, then to zero, and closes the device: some 60 ms. Without a thread the ramp's
  /// ticks follow each other at once, a millisecond apart in the loop's time.
  ~HapticSession();

  HapticLoop& loop() noexcept;
  const HapticLoop& loop() const noexcept;
  Device& device() noexcept;
  const Device& device() const noexcept;
  const Scheduling& scheduling() const noexcept;

  /// Lateness and duration of the thread's ticks; empty without a thread.
  const LoopTiming& timing() const noexcept;

  /// Writes the trace up to the last tick; a thread does that by itself. The trace takes the loop's
  /// records: pop_record() is for sessions without one.
  void drain_trace() noexcept;
  /// All zero without a trace.
  TraceStatus trace_status() const noexcept;
  /// TraceStatus::error, at once: trace_status() may wait for a disk.
  int trace_error() const noexcept;

  /// CLOCK_MONOTONIC, nanoseconds.
  static int64_t monotonic_now_ns() noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spidar
