// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The test force for a delay measurement.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>

namespace spidar {

/// A sum of sines with equal amplitudes and random phases. Each completes a whole number of cycles
/// per second.
class Multisine {
 public:
  /// Primes, so that no harmonic of one line falls on another, and at least 2 Hz apart, so that a
  /// Hann window of one second separates them. Below 11 Hz tremor and drift of the hand dominate;
  /// above 83 Hz a grip hardly moves.
  static constexpr std::array<double, 19> kFrequency_Hz = {11, 13, 17, 19, 23, 29, 31, 37, 41, 43,
                                                           47, 53, 59, 61, 67, 71, 73, 79, 83};
  static constexpr double kPeriod_s = 1;

  /// Scales the signal so that its largest absolute value is `peak`.
  template <typename Random>
  Multisine(Random& random, double peak) {
    std::uniform_real_distribution<double> turn(0, 2 * M_PI);
    for (double& phase : phase_rad_) phase = turn(random);
    double largest = 0;
    constexpr int kSamples = 1000;
    for (int i = 0; i < kSamples; ++i)
      largest = std::max(largest, std::abs(at(kPeriod_s * i / kSamples)));
    amplitude_ = peak / largest;
  }

  double at(double time_s) const noexcept {
    double sum = 0;
    for (size_t i = 0; i < phase_rad_.size(); ++i)
      sum += std::sin(2 * M_PI * kFrequency_Hz[i] * time_s + phase_rad_[i]);
    return amplitude_ * sum;
  }

  double amplitude() const noexcept { return amplitude_; }

 private:
  std::array<double, kFrequency_Hz.size()> phase_rad_{};
  double amplitude_ = 1;
};

}  // namespace spidar
