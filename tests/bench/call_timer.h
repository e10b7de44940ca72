// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Times single calls of some hundred nanoseconds: pinned to a core, with warm caches, each call by
/// the median of several passes.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <sched.h>
#include <vector>

namespace spidar::bench {

inline void pin_to_one_core() {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(sched_getcpu(), &set);
  if (sched_setaffinity(0, sizeof set, &set) != 0) std::puts("(not pinned to a core)");
}

inline double now_ns() {
  return std::chrono::duration<double, std::nano>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

inline double clock_overhead_ns() {
  static const double overhead = [] {
    std::vector<double> samples;
    for (int i = 0; i < 1001; ++i) {
      const double begin = now_ns();
      samples.push_back(now_ns() - begin);
    }
    std::nth_element(samples.begin(), samples.begin() + 500, samples.end());
    return samples[500];
  }();
  return overhead;
}

/// `q` between 0 and 1.
inline double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<size_t>(q * static_cast<double>(values.size() - 1) + 0.5)];
}

/// Nanoseconds of calls: the median of the passes, and the fastest. A slow case of the algorithm is
/// slow in every pass; what only the median shows came from elsewhere.
struct CallTimes {
  std::vector<double> median;
  std::vector<double> least;
};

/// Times `count` calls of call(0), call(1), …; before each pass begin() is called.
template <typename Begin, typename Call>
CallTimes time_calls(size_t count, int passes, Begin begin, Call call) {
  std::vector<std::vector<double>> samples(count);
  for (int pass = 0; pass < passes; ++pass) {
    begin();
    for (size_t i = 0; i < count; ++i) {
      const double start = now_ns();
      call(i);
      samples[i].push_back(now_ns() - start - clock_overhead_ns());
    }
  }
  CallTimes times;
  for (const auto& s : samples) {
    times.median.push_back(quantile(s, 0.5));
    times.least.push_back(quantile(s, 0));
  }
  return times;
}

}  // namespace spidar::bench
