// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/conformance/response_lines.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace spidar {
namespace {

constexpr double kTurn = 2 * M_PI / Multisine::kPeriod_s;

std::complex<double> turned(double angle_rad) {
  return {std::cos(angle_rad), -std::sin(angle_rad)};
}

/// ∫ exp(−jνs) ds from `from_s` to `to_s`, ν not zero.
std::complex<double> held(double rate_rad_s, double from_s, double to_s) {
  const std::complex<double> j(0, 1);
  return (turned(rate_rad_s * from_s) - turned(rate_rad_s * to_s)) / (j * rate_rad_s);
}

/// The same integral with the window 1 − cos(2πs/period).
std::complex<double> held_in_window(double rate_rad_s, double from_s, double to_s) {
  return held(rate_rad_s, from_s, to_s) - 0.5 * held(rate_rad_s - kTurn, from_s, to_s) -
         0.5 * held(rate_rad_s + kTurn, from_s, to_s);
}

double window(double time_s) {
  return 1 - std::cos(kTurn * time_s);
}

}  // namespace

// The force is constant between two calls, so its integral is exact. The position is known only at
// the calls. With calls one millisecond apart the trapezoidal rule is exact for a periodic signal
// without components above 500 Hz; late calls add an error of a few thousandths at most.
void PeriodSums::add(double time_s, double force_N, double place_m) noexcept {
  const double at_s = time_s - begin_s_;
  if (!started_) first_m_ = place_m;
  const double from_s = std::clamp(from_s_, 0.0, Multisine::kPeriod_s);
  const double to_s = std::clamp(at_s, 0.0, Multisine::kPeriod_s);
  if (started_ && to_s > from_s) {
    longest_gap_s_ = std::max(longest_gap_s_, at_s - from_s_);
    const double half_s = 0.5 * (to_s - from_s);
    const double from_m = window(from_s) * (place_m_ - first_m_);
    const double to_m = window(to_s) * (place_m - first_m_);
    for (size_t i = 0; i < kLines; ++i) {
      const double rate_rad_s = 2 * M_PI * Multisine::kFrequency_Hz[i];
      force_[i] += force_N_ * held_in_window(rate_rad_s, from_s, to_s);
      place_[i] +=
          half_s * (from_m * turned(rate_rad_s * from_s) + to_m * turned(rate_rad_s * to_s));
    }
  }
  started_ = true;
  from_s_ = at_s;
  force_N_ = force_N;
  place_m_ = place_m;
}

std::vector<ResponseLine> average(const std::vector<PeriodSums>& periods) {
  if (periods.size() < 3)
    throw std::invalid_argument("average: " + std::to_string(periods.size()) +
                                " periods, must be three at least");
  std::vector<ResponseLine> lines(kLines);
  for (size_t i = 0; i < kLines; ++i) {
    double force = 0, place = 0;
    std::complex<double> both;
    for (const PeriodSums& period : periods) {
      force += std::norm(period.force()[i]);
      place += std::norm(period.place()[i]);
      both += period.place()[i] * std::conj(period.force()[i]);
    }
    lines[i].frequency_Hz = Multisine::kFrequency_Hz[i];
    lines[i].response = both / force;
    const double rest = std::max(0.0, place - std::norm(both) / force);
    lines[i].variance = rest / (static_cast<double>(periods.size() - 1) * force);
  }
  return lines;
}

}  // namespace spidar
