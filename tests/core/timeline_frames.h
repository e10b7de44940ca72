// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Wrenches of frames, for the tests of the timeline.
#pragma once

#include <cstdint>
#include <cstring>

#include "core/force/wrench_timeline.h"

namespace spidar::test {

constexpr int64_t kFrame_ns = 40'000'000;
constexpr int64_t kHold_ns = 100'000'000;

/// A wrench with six different, not round components.
inline Wrench wrench_of(double k) {
  return {{0.1 * k, -0.2 * k, 0.3 * k}, {0.01 * k, 0.02 / (k + 7), -0.03 * k}};
}

inline TimedWrench timed(int64_t time_ns, double k, int64_t hold_ns = kFrame_ns) {
  return {time_ns, hold_ns, wrench_of(k)};
}

inline bool same_bits(const Wrench& a, const Wrench& b) {
  const Eigen::Matrix<double, 6, 1> x = a.stacked();
  const Eigen::Matrix<double, 6, 1> y = b.stacked();
  return std::memcmp(x.data(), y.data(), sizeof(double) * 6) == 0;
}
}  // namespace spidar::test
