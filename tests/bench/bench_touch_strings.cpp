// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Measures the energy that a contact adds through the strings of the simulated device. The first
// argument sets the number of ticks for each scene and hand, the second one selects the case.
#include <cstdio>
#include <cstdlib>
#include <string>

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

}  // namespace

int main(int argc, char** argv) {
  const long ticks = argc > 1 ? std::atol(argv[1]) : 1'000'000;
  const std::string only = argc > 2 ? argv[2] : "";
  std::printf("Energy that contacts gave out, %ld ticks for each scene and hand:\n", ticks);
  for (const Case& c : kCases) {
    if (only.empty() || only == c.name) explore(c, ticks);
  }
}
