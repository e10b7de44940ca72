// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/force/wrench_timeline.h"
#include "spidar/device.h"
#include "spidar/grip/grip.h"
#include "spidar/limits/vibration_budget.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/loop/loop_time.h"
#include "spidar/loop/tick_trace.h"
#include "spidar/profiles/profile.h"
#include "spidar/realtime/thread_setup.h"

namespace spidar {

struct SessionSettings {
  SafetyLimits limits;
  bool threaded = true;   ///< false: the owner calls loop().tick()
  bool real_time = true;  ///< requests real-time priority, but also works without
};

class HapticSession {
 public:
  /// Opens the grip and starts the loop. Throws DeviceError. A player uses a device through this
  /// class, which owns the loop, its thread, and the trace file.
  explicit HapticSession(std::unique_ptr<Grip> grip, const SessionSettings& settings = {});
  /// Makes a session with a grip on the strings of this device. Throws std::invalid_argument when
  /// the profile has fewer than six strings.
  HapticSession(const Profile& profile, std::unique_ptr<StringDevice> device,
                const SessionSettings& settings = {});
  /// Ramps to zero and closes the device, within some 60 ms. Without a thread, the ticks of the
  /// ramp run immediately, a millisecond apart in the loop's time.
  ~HapticSession();

  HapticLoop& loop() noexcept;
  const HapticLoop& loop() const noexcept;
  const Grip& grip() const noexcept { return loop().grip(); }
  /// Grip::description() when this session opened the device.
  const std::string& opened() const noexcept;
  const Scheduling& scheduling() const noexcept;

  /// Lateness and duration of the thread's ticks; empty without a thread.
  const LoopTiming& timing() const noexcept;

  /// Begins a trace: CSV, one row a tick, from the first tick on if the loop still stores it. One
  /// trace for each session. Throws std::runtime_error when the file cannot be written.
  void begin_trace(const std::string& path);
  /// Writes the trace up to the last tick, as the thread does by itself. The trace consumes the
  /// loop's records: pop_record() is for sessions without a trace.
  void drain_trace() noexcept;
  /// The status of the trace, if there is one. Does not wait for the file.
  LineWriter::Status trace_status() const noexcept;

  /// Why VibrationMemory::of_user() cannot be used; empty if it can.
  std::string vibration_error() const;

  static int64_t monotonic_now_ns() noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spidar
