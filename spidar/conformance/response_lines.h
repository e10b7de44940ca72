// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The frequency response of a grip to a force.
#pragma once

#include <array>
#include <complex>
#include <vector>

#include "spidar/conformance/multisine.h"

namespace spidar {

constexpr size_t kLines = Multisine::kFrequency_Hz.size();

/// The frequency response at one frequency, averaged over periods.
struct ResponseLine {
  double frequency_Hz = 0;
  std::complex<double> response;  ///< motion per force, m/N
  double variance = 0;            ///< mean |error|² of `response`, (m/N)²
};

/// Fourier sums of the force and the motion over one period with a Hann window. The drift of the
/// hand is not periodic and is large compared with the response; the window reduces its leakage
/// into the lines.
class PeriodSums {
 public:
  /// The period begins at `begin_s`.
  explicit PeriodSums(double begin_s) : begin_s_(begin_s) {}

  /// Call in order of time. At `time_s` the grip is at `place_m`, and `force_N` applies from then
  /// until the next call. Times outside the period are ignored.
  void add(double time_s, double force_N, double place_m) noexcept;

  const std::array<std::complex<double>, kLines>& force() const noexcept { return force_; }
  const std::array<std::complex<double>, kLines>& place() const noexcept { return place_; }
  /// The longest time between two calls within the period, s.
  double longest_gap_s() const noexcept { return longest_gap_s_; }

 private:
  const double begin_s_;
  bool started_ = false;
  double from_s_ = 0;
  double force_N_ = 0;
  double place_m_ = 0;
  double first_m_ = 0;
  double longest_gap_s_ = 0;
  std::array<std::complex<double>, kLines> force_{};
  std::array<std::complex<double>, kLines> place_{};
};

/// Averages the response over periods with different phases and estimates the variance from their
/// differences. The variance covers the hand, the quantization of encoder and D/A converter, and
/// nonlinearity (J. Schoukens, R. Pintelon, Y. Rolain, "Mastering System Identification in 100
/// Exercises", chapter 4). Needs at least three periods.
std::vector<ResponseLine> average(const std::vector<PeriodSums>& periods);

}  // namespace spidar
