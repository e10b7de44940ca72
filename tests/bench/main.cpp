// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// spidar-bench NAME [ARGUMENT...]: one benchmark. Without a name, says which there are.
#include <cstdio>
#include <cstring>
#include <exception>

#include <gst/gst.h>

#include "tests/bench/benchmarks.h"

namespace {

struct Benchmark {
  const char* name;
  int (*run)(int argc, char** argv);
  const char* what;
};

using namespace spidar::bench;

const Benchmark kBenchmarks[] = {
    {"camera", camera, "[TEXT]          how the camera moves where little shows it"},
    {"cost", cost, "                the element in a pipeline"},
    {"ladder", ladder, "                orders of the camera's motion, as chosen and fixed"},
    {"lag", lag, "                the force behind a motion on the screen"},
    {"loop", loop, "[SECONDS]       how late the 1 kHz loop wakes, and how long a tick takes"},
    {"pose", pose, "                time and error of the pose solver"},
#ifdef HAS_REAL_FILM
    {"real_film", real_film, "METHOD FILM     the motion in a film; real_films.sh makes the table"},
#endif
    {"regression", regression, "                a figure a topic; regression.py compares them"},
    {"released", released,
     "[GRIPS] [SEED] [CASE]  the worst that a search finds of grips that are let go of, or\n"
     "                        --prove: what no film exceeds"},
    {"safety", safety, "                the figures of docs/safety.md"},
    {"skew", skew, "[SECONDS]       time from a picture to its force"},
    {"stability", stability, "                errors of fits, poses and pictures that are hard"},
    {"tension", tension,
     "[COUNT]         the tension solver, also on COUNT problems of each hard family"},
    {"touch_strings", touch_strings, "[TICKS]         energy that contacts give out"},
    {"turns", turns, "                roll and growth of balls that turn and grow"},
    {"workspace", workspace, "                what the strings of each profile leave of 3 N"},
};

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);  // a row when it is known, into files too
  for (const Benchmark& each : kBenchmarks) {
    if (argc < 2 || std::strcmp(argv[1], each.name) != 0) continue;
    gst_init(nullptr, nullptr);
    try {
      return each.run(argc - 1, argv + 1);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "spidar-bench %s: %s\n", each.name, error.what());
      return 1;
    }
  }
  std::puts("usage: spidar-bench NAME [ARGUMENT...]");
  for (const Benchmark& each : kBenchmarks) std::printf("  %-13s %s\n", each.name, each.what);
  return 2;
}
