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
#include <utility>
#include <vector>

#include <gst/gst.h>

#include "tests/bench/benchmarks.h"
#include "tests/bench/busy_cores.h"
#include "tests/bench/call_timer.h"
#include "tests/bench/gst_pipeline.h"
#include "tests/bench/skew/measure.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace spidar::bench;

constexpr Scenario kScenarios[] = {
    {"file, playbin", "playbin"},
    {"file, playbin3", "playbin3"},
    {"live", nullptr},
    {"file at rate 0.5", "playbin", 0.5},
    {"file at rate 2", "playbin", 2},
    {"file after 100 seeks", "playbin", 1, 100},
    {"file, clock +300 ppm", "playbin", 1, 0, true},
    {"the same after 100 seeks", "playbin", 1, 100, true},
};

/// A ball jumps about for `seconds`: 1280x720, 29.97 frames/s, VP8 with a key frame every half
/// second, in AVI, which counts frames exactly. Throws std::runtime_error.
void make_clip(const std::string& path, int seconds) {
  constexpr int kFrames_s = 30;
  Pipeline pipeline("videotestsrc pattern=ball num-buffers=" + std::to_string(seconds * kFrames_s) +
                    " ! video/x-raw,format=I420,width=1280,height=720,framerate=30000/1001 "
                    "! vp8enc deadline=1 cpu-used=16 keyframe-max-dist=15 threads=2 ! avimux "
                    "! filesink location=\"" +
                    path + "\"");
  pipeline.play();
  pipeline.wait_for_end();
}

/// With lines between the columns, as documents have them.
void print_head() {
  double load_average = 0;
  getloadavg(&load_average, 1);
  std::printf(
      "skew: force at the device − picture at the sink, ms; 99 %%: of its size.\n"
      "busy: with a computing thread for every core. ppm: drift of the pipeline's clock.\n"
      "Load average before the start: %.2f; what else the machine does is in the figures.\n\n",
      load_average);
  std::printf("| %-25s | %-5s | %6s | %6s | %6s | %7s | %8s | %7s | %4s |\n", "playback", "cores",
              "frames", "median", "99 %", "worst", "not felt", "dropped", "ppm");
  std::printf("|---|---|---|---|---|---|---|---|---|\n");
}

/// `fraction` between 0 and 1: of the sizes.
double size_of(std::vector<double> values, double fraction) {
  for (double& value : values) value = std::abs(value);
  return quantile(std::move(values), fraction);
}

void print_row(const Scenario& scenario, const char* cores, const Measurement& m) {
  std::printf("| %-25s | %-5s | %6llu | %+6.2f | %6.2f | %7.2f | %8llu | %7llu | %4ld |\n",
              scenario.what, cores, static_cast<unsigned long long>(m.shown),
              quantile(m.skew_ms, 0.5), size_of(m.skew_ms, 0.99), size_of(m.skew_ms, 1),
              static_cast<unsigned long long>(m.shown - m.skew_ms.size()),
              static_cast<unsigned long long>(m.dropped), std::lround(m.clock_ppm));
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
    std::printf("| %-25s | %-5s | not measured: %s |\n", scenario.what, cores, error.what());
    return false;
  }
}

}  // namespace

int spidar::bench::skew(int argc, char** argv) {
  const int seconds = argc > 1 ? std::atoi(argv[1]) : 6;
  if (seconds < 1) {
    throw std::invalid_argument(std::string(argv[1]) + " is not a number of seconds above 0");
  }
  print_head();
  const spidar::test::TemporaryFolder folder;
  const std::string clip = folder.path / "clip.avi";
  // At twice the rate, and with what is played before and after the measurement.
  make_clip(clip, 2 * seconds + 4);
  bool all_good = true;
  std::string scheduling;
  for (const Scenario& scenario : kScenarios) {
    all_good &= report(scenario, "free", clip, seconds, scheduling);
    const BusyCores load;
    all_good &= report(scenario, "busy", clip, seconds, scheduling);
  }
  std::printf("\nhaptic thread: %s\n", scheduling.c_str());
  return all_good ? 0 : 1;
}
