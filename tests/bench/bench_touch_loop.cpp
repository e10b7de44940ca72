// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Measures the cost of touch per tick of the haptic loop and per frame. Times whole ticks on the
// simulated device, alternately with and without a moving relief under the grip.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <random>
#include <vector>

#include "plugin/touch/relief_stream.h"
#include "spidar/grip/string_grip.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/simulation/simulated_device.h"
#include "tests/bench/call_timer.h"

namespace {

using namespace spidar;

constexpr int64_t kFrame_ns = 33 * kTick_ns;
constexpr int kTicks = 60000;

std::vector<uint8_t> noise(int width, int height) {
  std::mt19937 random(1);
  std::vector<uint8_t> pixels(static_cast<size_t>(width * height));
  for (uint8_t& pixel : pixels) pixel = static_cast<uint8_t>(random());
  return pixels;
}

Frame analysis_of(int width, int height) {
  Frame analysis;
  analysis.width = width;
  analysis.height = height;
  return analysis;
}

/// A haptic loop whose hand presses and strokes the surface while new frames arrive.
struct Bench {
  Bench() : loop(std::make_unique<HapticLoop>(std::make_unique<StringGrip>(profile, device))) {
    stream.connect(loop.get(), profile, {0.0295, 0.032});
    loop->open();
    now_ns = 1'000'000'000'000;
    loop->set_playback_clock({now_ns, 0, 1.0, true});
  }

  /// Runs a tick and returns its duration.
  double tick(int n, bool touches) {
    if (touches && now_ns % kFrame_ns == 0) {
      TouchProperties touch;
      touch.kind = TouchKind::kLuma;
      touch.texture = 1;
      const int64_t running_ns = now_ns - 1'000'000'000'000 + 2 * kFrame_ns;
      stream.add({picture.data(), 426, 240, 426}, analysis_of(426, 240), running_ns, touch,
                 {0.5, 0.5});
    }
    Pose hand;
    hand.position_m = {0.02 * std::sin(0.002 * n), 0.02 * std::sin(0.0013 * n), -0.006};
    device.set_hand(hand);
    now_ns += kTick_ns;
    const double begin = bench::now_ns();
    loop->tick(now_ns, now_ns);
    return bench::now_ns() - begin;
  }

  const Profile profile = load_profile(kDefaultProfile);
  const std::vector<uint8_t> picture = noise(426, 240);
  SimulatedDevice device{profile, SimulatedDevice::Time::kFixedStep};
  std::unique_ptr<HapticLoop> loop;
  ReliefStream stream;
  int64_t now_ns = 0;
};

/// The force changes the work of the tension solver. For comparison, a second loop without contact
/// runs with a film force of similar size.
void time_ticks() {
  Bench plain;
  Bench pushed;
  Bench touched;
  std::vector<double> plain_ns, pushed_ns, touched_ns;
  int contacts = 0;
  for (int n = 0; n < kTicks; ++n) {
    if (n % 33 == 0) {
      const int64_t running_ns = pushed.now_ns - 1'000'000'000'000 + kFrame_ns;
      pushed.loop->schedule({running_ns, 2 * kFrame_ns, {{0.3, -0.2, 1.5}, {0, 0, 0}}});
    }
    plain_ns.push_back(plain.tick(n, false));
    pushed_ns.push_back(pushed.tick(n, false));
    touched_ns.push_back(touched.tick(n, true));
    contacts += touched.loop->snapshot().last.contact.touching;
  }
  const auto print = [](const char* name, const std::vector<double>& times_ns) {
    std::printf("%-44s median %7.2f, 99.9 %% %8.2f µs\n", name,
                1e-3 * bench::quantile(times_ns, 0.5), 1e-3 * bench::quantile(times_ns, 0.999));
  };
  std::printf("A tick, device included (%d of %d in contact):\n", contacts, kTicks);
  print("at rest", plain_ns);
  print("a force of the film", pushed_ns);
  print("touching, between two frames, with texture", touched_ns);
}

void time_frames() {
  std::puts("\nA frame's relief, with texture and hand-over, from pictures of noise:");
  for (const auto& [width, height] :
       {std::pair{320, 240}, {640, 480}, {1280, 720}, {1920, 1080}, {3840, 2160}}) {
    Bench bench;
    const std::vector<uint8_t> picture = noise(width, height);
    TouchProperties touch;
    touch.kind = TouchKind::kLuma;
    touch.texture = 1;
    std::vector<double> times_ns;
    for (int n = 0; n < 300; ++n) {
      bench.stream.forget();
      bench.tick(n, false);  // frees slots in the mailbox
      const double begin = bench::now_ns();
      bench.stream.add({picture.data(), width, height, width}, analysis_of(width, height), n, touch,
                       {0.5, 0.5});
      times_ns.push_back(bench::now_ns() - begin);
    }
    std::printf("  %d×%d: median %.2f, 99 %% %.2f ms\n", width, height,
                1e-6 * bench::quantile(times_ns, 0.5), 1e-6 * bench::quantile(times_ns, 0.99));
  }
}

}  // namespace

int main() {
  bench::pin_to_one_core();
  time_ticks();
  time_frames();
}
