// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A haptic loop on a fake device, ticked by hand.
#pragma once

#include <memory>

#include "spidar/loop/haptic_loop.h"
#include "spidar/loop/string_grip.h"
#include "spidar/profiles/profile.h"
#include "tests/support/fake_device.h"

namespace spidar::test {

constexpr int64_t kMs = 1'000'000;

inline Wrench push_right(double force_N) {
  return {{force_N, 0, 0}, {0, 0, 0}};
}

struct LoopDriver {
  explicit LoopDriver(const SafetyLimits& limits = {},
                      const Profile& of = load_profile(kDefaultProfile))
      : profile(of),
        loop(std::make_unique<HapticLoop>(std::make_unique<StringGrip>(profile, device), limits)) {}

  /// One tick, `step_ns` after the last one and on time.
  TickRecord tick(int64_t step_ns = kTick_ns) {
    now_ns += step_ns;
    loop->tick(now_ns, now_ns);
    return loop->snapshot().last;
  }

  TickRecord run(int64_t duration_ns) {
    const int64_t end = now_ns + duration_ns;
    while (now_ns < end) tick();
    return loop->snapshot().last;
  }

  /// Opens the device and ticks until its strings are taut.
  void open() {
    loop->open();
    run(static_cast<int64_t>(HapticLoop::kEnergise_s * 1e9) + 2 * kMs);
  }

  /// Shows `running_ns` now, and continues from there.
  void play(int64_t running_ns) { loop->set_playback_clock({now_ns, running_ns, 1.0, true}); }
  void pause() { loop->set_playback_clock({now_ns, 0, 1.0, false}); }

  LoopCounters counters() const { return loop->snapshot().counters; }
  FakeDeviceLog& log() { return device.log(); }

  const Profile profile;
  FakeDevice device;
  std::unique_ptr<HapticLoop> loop;
  int64_t now_ns = 7'000'000'000'000;
};

/// Counts of a grip that is there.
inline void put_grip(LoopDriver& driver, const Pose& pose) {
  driver.log().count = counts_at(driver.profile, pose);
}

}  // namespace spidar::test
