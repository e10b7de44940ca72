// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Measures the energy that contacts add through the strings of the simulated device, as
// docs/strings.md has it. The argument is the number of ticks for each scene and hand.
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "tests/bench/benchmarks.h"
#include "tests/support/touched_strings.h"

namespace {

using namespace spidar;

test::StringTouch touch_of(double stiffness_N_m) {
  test::StringTouch touch;
  touch.contact.stiffness_N_m = stiffness_N_m;
  touch.contact.friction = 0.3;
  return touch;
}

void explore(const char* name, const test::StringTouch& touch, long ticks) {
  std::printf("| %s |", name);
  for (const test::Hand& hand : {test::kFirmHand, test::kLightHand}) {
    test::ContactEnergy all;
    for (const test::TouchScene& scene : test::touch_scenes()) {
      const test::ContactEnergy e = test::explore_through_strings(scene, touch, hand, ticks, 7);
      all.contacts += e.contacts;
      all.generating += e.generating;
      all.worst_J = std::max(all.worst_J, e.worst_J);
    }
    std::printf(" %d of %d, %.4f mJ at most |", all.generating, all.contacts, 1e3 * all.worst_J);
  }
  std::puts("");
}

}  // namespace

int spidar::bench::touch_strings(int argc, char** argv) {
  const long ticks = argc > 1 ? std::atol(argv[1]) : 1'000'000;
  std::puts(
      "| surface | firm hand: active contacts | light hand: active contacts |\n|---|---|---|");
  test::StringTouch touch = touch_of(800);
  explore("800 N/m with friction", touch, ticks);
  touch.film_N = 3;
  explore("800 N/m with friction, and a film of 3 N", touch, ticks);
  for (const double stiffness_N_m : {500.0, 800.0}) {
    touch = touch_of(stiffness_N_m);
    touch.more_lag_s = 0.003;
    explore(stiffness_N_m == 500 ? "500 N/m, drives lag 3 ms more than stated"
                                 : "800 N/m, drives lag 3 ms more than stated",
            touch, ticks);
  }
  return 0;
}
