// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Measures the energy that a contact adds through the strings of the simulated device. The first
// argument sets the number of ticks for each scene and hand, the second one selects the case:
// "lag" stands for drives that lag more than the profile says.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "spidar/loop/stiffness_limit.h"
#include "tests/bench/benchmarks.h"
#include "tests/support/touched_strings.h"

namespace {

using namespace spidar;

struct Case {
  const char* name;
  double stiffness_N_m;
  double damping;
  double friction;
  bool texture;
  double film_N;
  bool bounded = true;
};

constexpr Case kCases[] = {
    {"500 N/m", 500, 1.5, 0, false, 0},
    {"500 N/m, friction", 500, 1.5, 0.3, false, 0},
    {"500 N/m, friction, texture", 500, 1.5, 0.3, true, 0},
    {"500 N/m, friction, film of 1 N", 500, 1.5, 0.3, false, 1},
    {"500 N/m, friction, film of 3 N", 500, 1.5, 0.3, false, 3},
    {"500 N/m, friction, texture, film of 1 N", 500, 1.5, 0.3, true, 1},
    {"800 N/m, friction", 800, 1.5, 0.3, false, 0},
    {"800 N/m, friction, texture", 800, 1.5, 0.3, true, 0},
    {"800 N/m, friction, film of 1 N", 800, 1.5, 0.3, false, 1},
    {"800 N/m, friction, film of 3 N", 800, 1.5, 0.3, false, 3},
    {"700 N/m, no damping, no budget", 700, 0, 0, false, 0, false},
};

void explore(const Case& c, long ticks) {
  std::printf("%s\n", c.name);
  test::StringTouch touch;
  touch.contact.stiffness_N_m = c.stiffness_N_m;
  touch.contact.damping = c.damping;
  touch.contact.friction = {c.friction, 0.8 * c.friction};
  touch.contact.bounds_energy = c.bounded;
  touch.texture = c.texture;
  touch.film_N = c.film_N;
  test::ContactEnergy all[2];
  for (const test::TouchScene& scene : test::touch_scenes()) {
    std::printf("  %-20s", scene.name.c_str());
    int n = 0;
    for (const test::Hand& hand : {test::kFirmHand, test::kLightHand}) {
      const test::ContactEnergy e = test::explore_through_strings(scene, touch, hand, ticks, 7);
      all[n].contacts += e.contacts;
      all[n].generating += e.generating;
      all[n].worst_J = std::max(all[n].worst_J, e.worst_J);
      ++n;
      std::printf("  %s: %d of %d, worst %.4f mJ", hand.name, e.generating, e.contacts,
                  1e3 * e.worst_J);
    }
    std::puts("");
  }
  for (int n = 0; n < 2; ++n) {
    std::printf("  %s hand: %d of %d, worst %.4f mJ\n", n == 0 ? "firm" : "light",
                all[n].generating, all[n].contacts, 1e3 * all[n].worst_J);
  }
  std::fflush(stdout);
}

/// Hands that hardly damp, grips of several masses, and drives that lag more than stated.
void explore_lags(long ticks) {
  constexpr test::Hand kHands[] = {
      {"0.05 N s/m", 100, 0.05}, {"0.5 N s/m", 100, 0.5}, {"2 N s/m", 100, 2}};
  std::puts(
      "stiffness  more lag  grip     damping of the hand: contacts that gave out energy, worst, "
      "stiffness left");
  for (const double stiffness_N_m : {kUnmeasuredStiffness_N_m, 500.0, 800.0}) {
    for (const double more_lag_s : {0.0, 0.001, 0.003}) {
      for (const double mass_kg : {0.05, 0.3}) {
        std::printf("%3.0f N/m    %1.0f ms      %.2f kg", stiffness_N_m, 1e3 * more_lag_s, mass_kg);
        for (const test::Hand& hand : kHands) {
          test::StringTouch touch;
          touch.contact.stiffness_N_m = stiffness_N_m;
          touch.contact.friction = {0.3, 0.24};
          touch.more_lag_s = more_lag_s;
          if (stiffness_N_m == kUnmeasuredStiffness_N_m)
            touch.contact.delay_s = surface_delay_s(kUnmeasuredLag_s);
          touch.mass_kg = mass_kg;
          test::ContactEnergy all;
          double left = 1;
          for (const test::TouchScene& scene : test::touch_scenes()) {
            const test::ContactEnergy e =
                test::explore_through_strings(scene, touch, hand, ticks, 7);
            all.contacts += e.contacts;
            all.generating += e.generating;
            all.worst_J = std::max(all.worst_J, e.worst_J);
            left = std::min(left, e.stiffness_share);
          }
          std::printf("  %s: %d of %d, %.4f mJ, %.2f", hand.name, all.generating, all.contacts,
                      1e3 * all.worst_J, left);
          std::fflush(stdout);
        }
        std::puts("");
      }
    }
  }
}

}  // namespace

int spidar::bench::touch_strings(int argc, char** argv) {
  const long ticks = argc > 1 ? std::atol(argv[1]) : 1'000'000;
  const std::string only = argc > 2 ? argv[2] : "";
  if (only == "lag") return explore_lags(ticks), 0;
  std::printf("Energy that contacts gave out, %ld ticks for each scene and hand:\n", ticks);
  for (const Case& c : kCases) {
    if (only.empty() || only == c.name) explore(c, ticks);
  }
  return 0;
}
