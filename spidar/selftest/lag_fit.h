// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The force that measures the lag of a drive, the response of a grip to that force, and the lag.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

namespace spidar::selftest {

/// A sum of sines with equal amplitudes and random phases. Each sine completes a whole number of
/// cycles per second.
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
    for (int i = 0; i < kSamples; ++i) {
      largest = std::max(largest, std::abs(at(kPeriod_s * i / kSamples)));
    }
    amplitude_ = peak / largest;
  }

  double at(double time_s) const noexcept {
    double sum = 0;
    for (size_t i = 0; i < phase_rad_.size(); ++i) {
      sum += std::sin(2 * M_PI * kFrequency_Hz[i] * time_s + phase_rad_[i]);
    }
    return amplitude_ * sum;
  }

  double amplitude() const noexcept { return amplitude_; }

 private:
  std::array<double, kFrequency_Hz.size()> phase_rad_{};
  double amplitude_ = 1;
};

constexpr size_t kLines = Multisine::kFrequency_Hz.size();

/// The frequency response at one frequency, averaged over periods.
struct ResponseLine {
  double frequency_Hz = 0;
  std::complex<double> response;  ///< motion per force, m/N
  double variance = 0;            ///< mean |error|² of `response`, (m/N)²
};

/// Fourier sums of the force and the motion over one period with a Hann window. The drift of the
/// hand is not periodic and is large compared with the response; the window limits its leakage.
class PeriodSums {
 public:
  explicit PeriodSums(double begin_s) : begin_s_(begin_s) {}

  /// Adds the position of the grip at `time_s`, and the force that applies from then until the next
  /// call. Times must increase; those outside the period are ignored.
  void add(double time_s, double force_N, double position_m) noexcept;

  const std::array<std::complex<double>, kLines>& force() const noexcept { return force_; }
  const std::array<std::complex<double>, kLines>& position() const noexcept { return position_; }
  /// The longest time between two calls within the period, s.
  double longest_gap_s() const noexcept { return longest_gap_s_; }

 private:
  const double begin_s_;
  bool started_ = false;
  double from_s_ = 0;
  double force_N_ = 0;
  double position_m_ = 0;
  double first_m_ = 0;
  double longest_gap_s_ = 0;
  std::array<std::complex<double>, kLines> force_{};
  std::array<std::complex<double>, kLines> position_{};
};

/// Averages the response over periods with different phases and estimates the variance from their
/// differences. The variance covers the hand, the quantization of encoder and D/A converter, and
/// nonlinearity (J. Schoukens, R. Pintelon, Y. Rolain, "Mastering System Identification in 100
/// Exercises", chapter 4). Needs at least three periods.
std::vector<ResponseLine> average(const std::vector<PeriodSums>& periods);

struct LagFit {
  std::string error;   ///< why there is no result, as a sentence; empty if there is one
  double lag_s = 0;    ///< the best estimate
  double error_s = 0;  ///< standard error of lag_s
  /// The confidence interval of 99.7 %: three standard errors to either side.
  double least_s = 0;
  double most_s = 0;
  /// The deviation of the response from the model, relative to the noise: the square root of chi²
  /// per degree of freedom.
  double misfit = 0;
};

/// A longer lag is not reported: no surface should be touched with it.
constexpr double kLongestLag_s = 0.03;
/// The largest half-width of a usable interval: this time or this fraction of the lag.
constexpr double kVagueLag_s = 0.001;
constexpr double kVagueLagFraction = 0.15;

/// Fits D(jω) / (−mω² + jωd + k) to the response. The model is a rigid grip of mass m with the
/// spring k and damper d of the hand, driven through D(jω) = exp(−jωτ) / (1 + jωT), a pure delay
/// and a first-order lag in any proportion. The lag is τ + T, the low-frequency delay of D, which
/// the damping of a surface has to compensate. The lag and the damping can be distinguished,
/// because the phase of the lag grows with frequency while that of the damping falls.
///
/// The model assumes that neither the grip nor the hand resonates between 11 and 83 Hz, and that
/// the strings stretch little compared with the motion of the grip. A violation appears as misfit.
/// `periods` is the number of periods that the lines average.
LagFit fit_lag(const std::vector<ResponseLine>& lines, int periods);

}  // namespace spidar::selftest
