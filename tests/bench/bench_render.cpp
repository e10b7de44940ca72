// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// How long `spidartrack render` takes for an hour of film, on one core. Whole programs.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sched.h>
#include <string>
#include <sys/resource.h>

#include "core/analysis/motion_file.h"
#include "tests/core/motion_rows.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace spidar;

/// An hour of 25 frames/s.
constexpr size_t kFrames = 90000;
constexpr int kTurns = 3;

double children_s() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace

int main() {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  CPU_SET(sched_getcpu(), &cores);
  if (sched_setaffinity(0, sizeof cores, &cores) != 0) return EXIT_FAILURE;
  const test::TemporaryFolder folder;
  const std::string motion = (folder.path / "hour.motion").string();
  // Objects and a camera whose motions are pure noise: larger than a film's.
  std::ofstream(motion, std::ios::binary) << test::random_film(1, kFrames).file();
  for (const char* settings : {"", "motion=objects controller=adaptive"}) {
    double least_s = 1e9;
    for (int turn = 0; turn < kTurns; ++turn) {
      const double before_s = children_s();
      const std::string command = std::string(SPIDARTRACK) + " render " + motion + " " +
                                  (folder.path / "hour.flac").string() + " -- " + settings +
                                  " > /dev/null";
      if (std::system(command.c_str()) != 0) return EXIT_FAILURE;
      least_s = std::min(least_s, children_s() - before_s);
    }
    std::printf("an hour of film, 25 frames/s, [%s]: %.1f s of one core\n", settings, least_s);
  }
  return EXIT_SUCCESS;
}
