// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Punctuality of the haptic loop: a session with its thread plays a rotating force on the simulated
// device, with and without real-time priority. The optional argument is the duration of each in
// seconds.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>

#include "spidar/session/device_factory.h"
#include "spidar/session/haptic_session.h"
#include "tests/bench/benchmarks.h"

namespace {

using namespace spidar;

constexpr int64_t kFrame_ns = 40'000'000;

/// Turns once a second.
Wrench force_at(int64_t running_ns) {
  const double angle = 2 * M_PI * 1e-9 * static_cast<double>(running_ns);
  return {{2 * std::cos(angle), 2 * std::sin(angle), 0}, {0, 0, 0.02 * std::sin(angle)}};
}

void print(const char* what, const LatencyHistogram& histogram) {
  const auto us = [&](double q) { return 1e-3 * static_cast<double>(histogram.quantile_ns(q)); };
  std::printf("  %-16s median %7.1f   99 %% %7.1f   99.9 %% %7.1f   max %8.1f µs\n", what, us(0.5),
              us(0.99), us(0.999), 1e-3 * static_cast<double>(histogram.max_ns()));
}

void run(const Profile& profile, bool real_time, double seconds) {
  SessionSettings settings;
  settings.real_time = real_time;
  HapticSession session(profile, make_device("sim", profile), settings);
  const int64_t begin_ns = HapticSession::monotonic_now_ns();
  session.loop().set_playback_clock({begin_ns, 0, 1.0, true});
  const auto frames = static_cast<int64_t>(seconds * 1e9 / kFrame_ns);
  for (int64_t i = 0; i < frames; ++i) {
    const int64_t running_ns = i * kFrame_ns;
    session.loop().schedule({running_ns, kFrame_ns, force_at(running_ns)});
    std::this_thread::sleep_for(std::chrono::nanoseconds(kFrame_ns));
  }
  const LoopCounters counters = session.loop().snapshot().counters;
  std::printf("real-time priority %s: %s\n", real_time ? "asked for" : "left out",
              session.scheduling().detail.c_str());
  print("wake-up latency", session.timing().lateness);
  print("cycle", session.timing().cycle);
  std::printf("  ticks %llu, more than a period late %llu, deadlines missed %llu\n",
              static_cast<unsigned long long>(counters.ticks),
              static_cast<unsigned long long>(counters.overruns),
              static_cast<unsigned long long>(counters.missed_deadlines));
}

}  // namespace

int spidar::bench::loop(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 5;
  if (!(seconds > 0)) {
    throw std::invalid_argument(std::string(argv[1]) + " is not a number of seconds above 0");
  }
  const Profile profile = load_profile(kDefaultProfile);
  run(profile, true, seconds);
  run(profile, false, seconds);
  return 0;
}
