// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Measures the cost of touch per frame and per tick, and the energy that a surface generates. The
// optional argument is the number of ticks for each scene and hand.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "core/touch/contact_force.h"
#include "core/touch/depth_picture.h"
#include "core/touch/relief.h"
#include "tests/bench/call_timer.h"
#include "tests/support/tap.h"
#include "tests/support/touch_surfaces.h"
#include "tests/support/touched_grip.h"

namespace {

using namespace spidar;
using bench::quantile;

void print_times(const char* name, const bench::CallTimes& times, double unit_ns) {
  std::printf("%-32s median %8.3f, 99.9 %% %8.3f\n", name, quantile(times.median, 0.5) / unit_ns,
              quantile(times.median, 0.999) / unit_ns);
}

void time_reliefs() {
  std::puts("A frame's relief, milliseconds:");
  constexpr size_t kFrames = 300;
  constexpr int kPasses = 3;
  HeightField field(0.06, 0.03375);
  std::mt19937 random(1);
  for (const auto& [width, height] :
       {std::pair{427, 240}, {640, 480}, {1920, 1080}, {8192, 8192}}) {
    std::vector<uint8_t> bytes(static_cast<size_t>(2 * width * height));
    for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(random());
    ReliefBuilder builder;
    char name[64];
    if (width <= 1920) {  // larger pictures are reduced first
      std::snprintf(name, sizeof name, "brightness, %d×%d", width, height);
      const ImageView picture{bytes.data(), width, height, width};
      print_times(name,
                  bench::time_calls(
                      kFrames, kPasses, [] {},
                      [&](size_t) { builder.from_brightness(picture, {}, field); }),
                  1e6);
    }
    std::snprintf(name, sizeof name, "depth of 16 bits, %d×%d", width, height);
    const DepthView depth{bytes.data(), width, height, 2 * width, 2, false};
    DepthPicture depth_picture;
    print_times(name,
                bench::time_calls(
                    kFrames, kPasses, [] {},
                    [&](size_t) {
                      depth_picture.read(depth, {}, 0.04);
                      builder.from_levels(depth_picture.levels(), {}, field);
                    }),
                1e6);
  }
}

void time_ticks(const std::vector<test::TouchScene>& scenes) {
  std::puts("\nA tick, microseconds:");
  constexpr size_t kTicks = 20000;
  constexpr int kPasses = 5;
  // 4 mm lower than in the other measurements, so that the hand is nearly always in contact.
  const test::RandomHand hand(7);
  std::vector<Eigen::Vector3d> grips_m;
  for (size_t n = 0; n < kTicks; ++n) {
    grips_m.push_back(hand.at_m(1e-3 * static_cast<double>(n)) - Eigen::Vector3d(0, 0, 0.004));
  }
  ContactSettings settings;
  settings.friction = {0.3, 0.24};
  const HeightField& relief = scenes[4].relief;
  const HeightField& texture = scenes[4].texture;
  const MovingRelief still{&relief};
  const MovingRelief moving{&relief, &scenes[5].relief, 0.4, {0.001, 0}};
  ContactForce force;
  Eigen::Vector3d sum_N = Eigen::Vector3d::Zero();
  size_t touching = 0;
  const auto time = [&](const char* name, const MovingRelief& surface, const HeightField* detail) {
    print_times(name,
                bench::time_calls(
                    kTicks, kPasses, [&] { force.reset(); },
                    [&](size_t n) {
                      sum_N += force.tick(surface, detail, settings, grips_m[n], 1e-3);
                      touching += force.proxy().touching();
                    }),
                1e3);
  };
  time("one frame", still, nullptr);
  time("between two frames", moving, nullptr);
  time("between two frames, texture", moving, &texture);
  constexpr double kAll = 3.0 * kPasses * kTicks;
  std::printf("(in contact in %.0f %% of them, mean force %.2f N)\n",
              100 * static_cast<double>(touching) / kAll, sum_N.norm() / kAll);
}

struct Case {
  const char* name;
  double stiffness_N_m;
  double damping;
  double friction;
  bool texture;
  bool bounded = true;
};

void explore_scenes(const std::vector<test::TouchScene>& scenes, long ticks) {
  std::printf("\nEnergy that contacts gave out, %ld ticks for each scene and hand:\n", ticks);
  for (const Case& c : {Case{"500 N/m", 500, 1.5, 0, false},
                        {"500 N/m, friction", 500, 1.5, 0.3, false},
                        {"500 N/m, friction, texture", 500, 1.5, 0.3, true},
                        {"800 N/m, friction", 800, 1.5, 0.3, false},
                        {"800 N/m, friction, texture", 800, 1.5, 0.3, true},
                        {"800 N/m, friction, texture, damping 1.2 K t_d", 800, 1.2, 0.3, true},
                        {"800 N/m, friction, texture, no budget", 800, 1.5, 0.3, true, false},
                        {"the same, damping 1.2 K t_d", 800, 1.2, 0.3, true, false},
                        {"700 N/m, no damping, no budget", 700, 0, 0, false, false}}) {
    ContactSettings settings;
    settings.stiffness_N_m = c.stiffness_N_m;
    settings.damping = c.damping;
    settings.friction = {c.friction, 0.8 * c.friction};
    settings.bounds_energy = c.bounded;
    std::printf("%s\n", c.name);
    for (const test::TouchScene& scene : scenes) {
      std::printf("  %-20s", scene.name.c_str());
      for (const test::Hand& hand : {test::kFirmHand, test::kLightHand}) {
        const test::ContactEnergy e = test::explore(
            {&scene.relief}, c.texture ? &scene.texture : nullptr, settings, hand, ticks, 7);
        std::printf("  %s: %d of %d, worst %.4f mJ", hand.name, e.generating, e.contacts,
                    1e3 * e.worst_J);
      }
      std::puts("");
    }
  }
}

void tap() {
  std::puts("\nEnergy that a tap of 6 mm gives out (below 0: takes), mJ, by the speed in m/s:");
  for (const bool bounded : {false, true}) {
    std::puts(bounded ? "with the energy budget" : "without the energy budget");
    for (const double stiffness_N_m : {500.0, 800.0}) {
      ContactSettings settings;
      settings.stiffness_N_m = stiffness_N_m;
      settings.bounds_energy = bounded;
      for (const test::Hand& hand : {test::kFirmHand, test::kLightHand, test::kLooseHand}) {
        std::printf("  %.0f N/m, %-6s", stiffness_N_m, hand.name);
        for (const double speed_m_s : {0.05, 0.1, 0.2, 0.3, 0.4, 0.5}) {
          std::printf("  %.2f: %8.4f", speed_m_s,
                      1e3 * test::tap_J(settings, hand, speed_m_s, 0.006));
        }
        std::printf("  worst of all: %8.4f\n", 1e3 * test::worst_tap_J(settings, hand));
      }
    }
  }
}

/// Real part of the impedance (K / jω + B / (1 + jω / ω60)) exp(−jω t_d), in units of K t_d.
double resistance(double frequency_Hz, double damping) {
  constexpr double kDelay_s = 0.0035;
  const double w = 2 * M_PI * frequency_Hz;
  const double lag = frequency_Hz / ContactForce::kVelocityCutoff_Hz;
  const double angle = w * kDelay_s;
  return -std::sin(angle) / angle +
         damping * (std::cos(angle) - lag * std::sin(angle)) / (1 + lag * lag);
}

void print_passive_band() {
  std::puts(
      "\nBy damping / (K t_d): passive alone up to; damping that it needs of the hand above:");
  for (const double damping : {1.0, 1.1, 1.2, 1.5, 2.0}) {
    double passive_Hz = 0;
    double least = 0;
    double least_Hz = 0;
    for (double f_Hz = 0.1; f_Hz < 500; f_Hz += 0.1) {
      const double r = resistance(f_Hz, damping);
      if (least == 0 && r >= 0) passive_Hz = f_Hz;
      if (r < least) {
        least = r;
        least_Hz = f_Hz;
      }
    }
    std::printf("  %.1f: %4.1f Hz; %.2f K t_d at %.0f Hz\n", damping, passive_Hz, -least, least_Hz);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const long ticks = argc > 1 ? std::atol(argv[1]) : 1'000'000;
  bench::pin_to_one_core();
  const std::vector<test::TouchScene> scenes = test::touch_scenes();
  time_reliefs();
  time_ticks(scenes);
  print_passive_band();
  tap();
  explore_scenes(scenes, ticks);
}
