// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Time from a picture to its force at the device, in real pipelines in real time, with the plugin
// as GStreamer loads it and the simulated device.
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gst/gst.h>

#include "tests/bench/skew/busy_cores.h"
#include "tests/bench/skew/clip.h"
#include "tests/bench/skew/measure.h"
#include "tests/bench/skew/scenario.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace spidar::bench;

constexpr const char* kUsage =
    "usage: bench_skew [OPTION...]\n"
    "  --seconds N        of each playback, default 6\n"
    "  --scenario NAME    only this one; may be given again\n"
    "  --free, --busy     only with free cores, or only with a busy thread on every one\n"
    "  --list             names of the scenarios\n";

struct Options {
  int seconds = 6;
  std::vector<Scenario> chosen;  ///< empty: all
  bool free_cores = true;
  bool busy_cores = true;
  bool list = false;
};

/// Throws std::invalid_argument.
Scenario find(const std::string& name) {
  for (const Scenario& scenario : scenarios()) {
    if (name == scenario.name) return scenario;
  }
  throw std::invalid_argument("there is no scenario '" + name + "'; see --list");
}

/// Throws std::invalid_argument.
int number_of_seconds(const std::string& text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size() && value >= 1 && value <= 600) {
    return value;
  }
  throw std::invalid_argument("--seconds: '" + text + "' is not a number from 1 to 600");
}

/// Throws std::invalid_argument.
Options parse(const std::vector<std::string>& arguments) {
  Options options;
  for (size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    if (argument == "--free") {
      options.busy_cores = false;
    } else if (argument == "--busy") {
      options.free_cores = false;
    } else if (argument == "--list") {
      options.list = true;
    } else if (argument == "--seconds" && i + 1 < arguments.size()) {
      options.seconds = number_of_seconds(arguments[++i]);
    } else if (argument == "--scenario" && i + 1 < arguments.size()) {
      options.chosen.push_back(find(arguments[++i]));
    } else {
      throw std::invalid_argument("unknown or incomplete option " + argument + "\n" + kUsage);
    }
  }
  if (options.chosen.empty()) options.chosen = scenarios();
  if (!options.free_cores && !options.busy_cores) options.free_cores = options.busy_cores = true;
  return options;
}

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

void print_row(const Scenario& scenario, const char* cores, const Measurement& m) {
  const Histogram& skew_ms = m.skew.signed_ms();
  const double worst_ms =
      std::fabs(skew_ms.min()) > std::fabs(skew_ms.max()) ? skew_ms.min() : skew_ms.max();
  std::printf(
      "| %-35s | %-5s | %6llu | %+6.2f | %6.2f | %+7.2f | %8llu | %7llu | %7.2f | %6.2f | %4ld "
      "|\n",
      scenario.what, cores, static_cast<unsigned long long>(m.shown), skew_ms.quantile(0.5),
      m.skew.size_ms().quantile(0.99), worst_ms, static_cast<unsigned long long>(m.not_felt()),
      static_cast<unsigned long long>(m.dropped), m.picture_ms.quantile(0.99),
      m.force.size_ms().quantile(0.99), std::lround(m.clock_ppm));
}

/// False when there is nothing to report.
bool report(const Scenario& scenario, const char* cores, const std::string& clip, int seconds,
            std::string& scheduling) {
  try {
    const Measurement measurement = measure(scenario, clip, seconds);
    scheduling = measurement.scheduling;
    if (measurement.skew.signed_ms().count() == 0) {
      throw std::runtime_error("no frame was both shown and felt");
    }
    print_row(scenario, cores, measurement);
    return true;
  } catch (const std::exception& error) {
    std::printf("| %-35s | %-5s | not measured: %s |\n", scenario.what, cores, error.what());
    return false;
  }
}

int run(const Options& options) {
  print_head();
  const spidar::test::TemporaryFolder folder;
  const std::string clip = folder.path / "clip.avi";
  // At twice the rate, and with what is played before and after the measurement.
  make_clip(clip, 2 * options.seconds + 4);
  make_track(track_of(clip), 2 * options.seconds + 4);
  bool all_good = true;
  std::string scheduling;
  for (const Scenario& scenario : options.chosen) {
    if (options.free_cores) all_good &= report(scenario, "free", clip, options.seconds, scheduling);
    if (options.busy_cores) {
      const BusyCores load(std::thread::hardware_concurrency());
      all_good &= report(scenario, "busy", clip, options.seconds, scheduling);
    }
  }
  std::printf("\nhaptic thread: %s\n", scheduling.c_str());
  return all_good ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  gst_init(&argc, &argv);
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  try {
    const Options options = parse({argv + 1, argv + argc});
    if (options.list) {
      for (const Scenario& scenario : scenarios()) {
        std::printf("%-12s %s\n", scenario.name, scenario.what);
      }
      return 0;
    }
    const std::string missing = missing_element();
    if (!missing.empty()) {
      std::printf("skipped: GStreamer element %s is not installed\n", missing.c_str());
      return 77;  // meson: skipped
    }
    return run(options);
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
