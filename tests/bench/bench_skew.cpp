// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Time from a picture to its force at the device, in real pipelines in real time, with the plugin
// as GStreamer loads it and the simulated device.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gst/gst.h>

#include "tests/bench/benchmarks.h"
#include "tests/bench/call_timer.h"
#include "tests/bench/skew/busy_cores.h"
#include "tests/bench/skew/clip.h"
#include "tests/bench/skew/measure.h"
#include "tests/bench/skew/scenario.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace spidar::bench;

/// With lines between the columns, as documents have them.
void print_head() {
  double load_average = 0;
  getloadavg(&load_average, 1);
  std::printf(
      "skew: force at the device − picture at the sink, ms; 99 %%: of its size.\n"
      "picture, force: 99 %% of what each is off the moment at which the picture was due, ms.\n"
      "busy: with a computing thread for every core. ppm: drift of the pipeline's clock.\n"
      "Load average before the start: %.2f; what else the machine does is in the figures.\n\n",
      load_average);
  std::printf("| %-35s | %-5s | %6s | %6s | %6s | %7s | %8s | %7s | %7s | %6s | %4s |\n",
              "playback", "cores", "frames", "median", "99 %", "worst", "not felt", "dropped",
              "picture", "force", "ppm");
  std::printf("|---|---|---|---|---|---|---|---|---|---|---|\n");
}

/// `share` between 0 and 1: of the sizes.
double size_of(std::vector<double> values, double share) {
  for (double& value : values) value = std::abs(value);
  return quantile(std::move(values), share);
}

void print_row(const Scenario& scenario, const char* cores, const Measurement& m) {
  std::printf(
      "| %-35s | %-5s | %6zu | %+6.2f | %6.2f | %7.2f | %8llu | %7llu | %7.2f | %6.2f | %4ld |\n",
      scenario.what, cores, m.picture_ms.size(), quantile(m.skew_ms, 0.5), size_of(m.skew_ms, 0.99),
      size_of(m.skew_ms, 1), static_cast<unsigned long long>(m.not_felt()),
      static_cast<unsigned long long>(m.dropped), quantile(m.picture_ms, 0.99),
      size_of(m.force_ms, 0.99), std::lround(m.clock_ppm));
}

/// False when there is nothing to report.
bool report(const Scenario& scenario, const char* cores, const std::string& clip, int seconds,
            std::string& scheduling) {
  try {
    const Measurement measurement = measure(scenario, clip, seconds);
    scheduling = measurement.scheduling;
    if (measurement.skew_ms.empty()) {
      throw std::runtime_error("no frame was both shown and felt");
    }
    print_row(scenario, cores, measurement);
    return true;
  } catch (const std::exception& error) {
    std::printf("| %-35s | %-5s | not measured: %s |\n", scenario.what, cores, error.what());
    return false;
  }
}

}  // namespace

int spidar::bench::skew(int argc, char** argv) {
  const int seconds = argc > 1 ? std::atoi(argv[1]) : 6;
  if (seconds < 1) {
    throw std::invalid_argument(std::string(argv[1]) + " is not a number of seconds above 0");
  }
  const std::string missing = missing_element();
  if (!missing.empty()) {
    std::printf("skipped: GStreamer element %s is not installed\n", missing.c_str());
    return 77;  // meson: skipped
  }
  print_head();
  const spidar::test::TemporaryFolder folder;
  const std::string clip = folder.path / "clip.avi";
  // At twice the rate, and with what is played before and after the measurement.
  make_clip(clip, 2 * seconds + 4);
  make_track(track_of(clip), 2 * seconds + 4);
  bool all_good = true;
  std::string scheduling;
  for (const Scenario& scenario : scenarios()) {
    all_good &= report(scenario, "free", clip, seconds, scheduling);
    const BusyCores load(std::thread::hardware_concurrency());
    all_good &= report(scenario, "busy", clip, seconds, scheduling);
  }
  std::printf("\nhaptic thread: %s\n", scheduling.c_str());
  return all_good ? 0 : 1;
}
