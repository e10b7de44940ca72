// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Counts how often the contact force of a depth film would exceed the slew limit.
//
//     bench_touch_film FILE WIDTH HEIGHT [FRAMES [disparity]]
//
// FILE contains 16-bit big-endian frames at 30 frames per second, as written by `pngdec !
// video/x-raw,format=GRAY16_BE ! filesink`. With `disparity`, it contains a single 8-bit frame
// (GRAY8) in which larger values are nearer; the hand touches it for the duration of FRAMES frames.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "core/touch/contact_force.h"
#include "core/touch/depth_picture.h"
#include "core/touch/relief.h"
#include "tests/support/touched_grip.h"

namespace {

using namespace spidar;

constexpr int kFrame_ticks = 33;
constexpr double kMaxForce_N = 3;
constexpr double kDeeper_m = 0.004;  // below a hand that touches only the nearest parts
constexpr unsigned kHands = 10;

std::vector<HeightField> reliefs_of(const std::vector<uint8_t>& film, int width, int height,
                                    size_t frames, bool disparity) {
  const int bytes = disparity ? 1 : 2;
  const size_t frame_bytes =
      static_cast<size_t>(bytes) * static_cast<size_t>(width) * static_cast<size_t>(height);
  const ReliefSettings settings{-0.006, 0.008, 5e-4};
  std::vector<HeightField> reliefs;
  DepthPicture picture;
  ReliefBuilder builder;
  for (size_t n = 0; n < frames && (n + 1) * frame_bytes <= film.size(); ++n) {
    HeightField relief(0.06, 0.06 * height / width);
    const DepthView view{film.data() + n * frame_bytes, width, height, bytes * width, bytes, true};
    if (picture.read(view, {disparity}, 1 / 30.0) &&
        builder.from_levels(picture.levels(), settings, relief)) {
      reliefs.push_back(relief);
    }
  }
  if (disparity && !reliefs.empty()) reliefs.resize(frames, HeightField(reliefs.front()));
  return reliefs;
}

void touch(const std::vector<HeightField>& reliefs, const test::Hand& hand,
           const ContactSettings& settings) {
  long ticks = 0;
  long touching = 0;
  long above = 0;
  for (unsigned seed = 1; seed <= kHands; ++seed) {
    const test::RandomHand random(seed);
    test::TouchedGrip grip(hand, {0, 0, 0.02});
    ContactForce force;
    Eigen::Vector3d last_N = Eigen::Vector3d::Zero();
    for (size_t frame = 0; frame + 1 < reliefs.size(); ++frame) {
      for (int t = 0; t < kFrame_ticks; ++t, ++ticks) {
        const MovingRelief relief{&reliefs[frame], &reliefs[frame + 1],
                                  static_cast<double>(t) / kFrame_ticks};
        Eigen::Vector3d wanted_N =
            force.tick(relief, nullptr, settings, grip.measured_m(), test::TouchedGrip::kTick_s);
        if (wanted_N.norm() > kMaxForce_N) wanted_N *= kMaxForce_N / wanted_N.norm();
        const double change_N = (wanted_N - last_N).norm();
        above += change_N > test::TouchedGrip::kMaxSlew_N_s * test::TouchedGrip::kTick_s ? 1 : 0;
        touching += force.proxy().touching() ? 1 : 0;
        last_N = wanted_N;
        const double time_s =
            test::TouchedGrip::kTick_s * static_cast<double>(frame * kFrame_ticks) +
            test::TouchedGrip::kTick_s * t;
        grip.exchange(wanted_N, random.at_m(time_s) - Eigen::Vector3d(0, 0, kDeeper_m));
      }
    }
  }
  std::printf("%-5s hand, %.0f N/m, %-14s touching %.0f %%, above the slew limit %.2f %%\n",
              hand.name, settings.stiffness_N_m,
              settings.bounds_energy ? "with budget:" : "without:",
              100.0 * static_cast<double>(touching) / static_cast<double>(ticks),
              100.0 * static_cast<double>(above) / static_cast<double>(ticks));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fputs("usage: bench_touch_film FILE WIDTH HEIGHT [FRAMES [disparity]]\n", stderr);
    return 2;
  }
  std::ifstream file(argv[1], std::ios::binary);
  const std::vector<uint8_t> film((std::istreambuf_iterator<char>(file)), {});
  const int width = std::atoi(argv[2]);
  const int height = std::atoi(argv[3]);
  const size_t most = argc > 4 ? static_cast<size_t>(std::atol(argv[4])) : film.size();
  if (width <= 0 || height <= 0) {
    std::fputs("WIDTH and HEIGHT have to be above 0\n", stderr);
    return 2;
  }
  const bool disparity = argc > 5 && std::string(argv[5]) == "disparity";
  const std::vector<HeightField> reliefs = reliefs_of(film, width, height, most, disparity);
  if (reliefs.size() < 2) {
    std::fprintf(stderr, "%s: fewer than two frames of %d×%d with depth\n", argv[1], width, height);
    return 1;
  }
  std::printf("%zu frames\n", reliefs.size());
  for (const double stiffness_N_m : {500.0, 800.0}) {
    for (const bool bounded : {true, false}) {
      for (const test::Hand& hand : {test::kFirmHand, test::kLightHand}) {
        ContactSettings settings;
        settings.stiffness_N_m = stiffness_N_m;
        settings.friction = {0.3, 0.24};
        settings.max_force_N = kMaxForce_N;
        settings.bounds_energy = bounded;
        touch(reliefs, hand, settings);
      }
    }
  }
}
