// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// An element on a simulated device, its loop ticked by hand.
#pragma once

#include "spidar/devices/sim/simulated_device.h"
#include "spidar/loop/haptic_loop.h"
#include "tests/support/element_harness.h"
#include "tests/support/test.h"
#include "tests/support/video_frames.h"

namespace spidar::test {

class SimulatedElement : public testing::Test {
 protected:
  void open(const std::string& properties, int width = 320, int height = 240) {
    h = std::make_unique<ElementHarness>(properties, [this] { return time_ns; });
    h->set_caps(make_caps("GRAY8", width, height));
  }

  HapticLoop& loop() { return h->state().feed.output.session()->loop(); }
  SimulatedDevice& device() { return *h->state().feed.output.simulated(); }

  void tick(int count = 1) {
    for (int i = 0; i < count; ++i) h->tick(time_ns += kTick_ns);
  }

  /// Running time begins, with a device that runs: energised and located.
  void play() {
    tick(kOpened_ms);
    PlaybackClock clock;
    clock.playing = true;
    clock.monotonic_ns = time_ns;
    loop().set_playback_clock(clock);
  }

  static constexpr int kOpened_ms = 300;
  int64_t time_ns = 1'000'000'000;
  int frames = 0;
  std::unique_ptr<ElementHarness> h;
};

}  // namespace spidar::test
