// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How a grip answers to a force at some frequencies.
#pragma once

#include <array>
#include <complex>
#include <vector>

#include "core/api.h"
#include "core/delay/multisine.h"

namespace spidar {

constexpr size_t kLines = Multisine::kFrequency_Hz.size();

/// The frequency response at one frequency, averaged over periods.
struct ResponseLine {
  double frequency_Hz = 0;
  std::complex<double> response;  ///< motion per force, m/N
  double variance = 0;            ///< of `response`: mean of |error|², (m/N)²
};

/// Fourier sums of one period of force and motion under a Hann window. The drift of a hand, which
/// is not periodic, is large beside the motion that is looked for; the window keeps it away from
/// the lines.
class SPIDAR_API PeriodSums {
 public:
  /// The period begins at `begin_s`.
  explicit PeriodSums(double begin_s) : begin_s_(begin_s) {}

  /// In the order of time: at `time_s` the grip is at `place_m`, and from then on `force_N` is
  /// wanted until the next call. What is outside the period does not count.
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

/// The mean over periods of different phases, and from how they differ its variance: that of the
/// hand, of the steps of encoder and D/A, and of what is not linear (J. Schoukens, R. Pintelon, Y.
/// Rolain, "Mastering System Identification in 100 Exercises", chapter 4). At least three periods.
SPIDAR_API std::vector<ResponseLine> average(const std::vector<PeriodSums>& periods);

}  // namespace spidar
