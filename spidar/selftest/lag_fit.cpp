// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/selftest/lag_fit.h"

#include <limits>
#include <stdexcept>

#include <Eigen/Dense>

#include "spidar/text.h"

namespace spidar::selftest {
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
void PeriodSums::add(double time_s, double force_N, double position_m) noexcept {
  const double at_s = time_s - begin_s_;
  if (!started_) first_m_ = position_m;
  const double from_s = std::clamp(from_s_, 0.0, Multisine::kPeriod_s);
  const double to_s = std::clamp(at_s, 0.0, Multisine::kPeriod_s);
  if (started_ && to_s > from_s) {
    longest_gap_s_ = std::max(longest_gap_s_, at_s - from_s_);
    const double half_s = 0.5 * (to_s - from_s);
    const double from_m = window(from_s) * (position_m_ - first_m_);
    const double to_m = window(to_s) * (position_m - first_m_);
    for (size_t i = 0; i < kLines; ++i) {
      const double rate_rad_s = 2 * M_PI * Multisine::kFrequency_Hz[i];
      force_[i] += force_N_ * held_in_window(rate_rad_s, from_s, to_s);
      position_[i] +=
          half_s * (from_m * turned(rate_rad_s * from_s) + to_m * turned(rate_rad_s * to_s));
    }
  }
  started_ = true;
  from_s_ = at_s;
  force_N_ = force_N;
  position_m_ = position_m;
}

std::vector<ResponseLine> average(const std::vector<PeriodSums>& periods) {
  if (periods.size() < 3) {
    throw std::invalid_argument("average: " + std::to_string(periods.size()) +
                                " periods, must be three at least");
  }
  std::vector<ResponseLine> lines(kLines);
  for (size_t i = 0; i < kLines; ++i) {
    double force = 0, position = 0;
    std::complex<double> both;
    for (const PeriodSums& period : periods) {
      force += std::norm(period.force()[i]);
      position += std::norm(period.position()[i]);
      both += period.position()[i] * std::conj(period.force()[i]);
    }
    lines[i].frequency_Hz = Multisine::kFrequency_Hz[i];
    lines[i].response = both / force;
    const double rest = std::max(0.0, position - std::norm(both) / force);
    lines[i].variance = rest / (static_cast<double>(periods.size() - 1) * force);
  }
  return lines;
}

namespace {

/// The pure delay is negative if a board reads its counters later in an exchange than it sets its
/// output voltages. The simulation has a negative delay because of its time steps.
constexpr double kShortestDelay_s = -0.001;
/// The search goes beyond kLongestLag_s to recognise a lag that is too long.
constexpr double kScanTo_s = 2 * kLongestLag_s;
constexpr double kScan_s = 5e-5;
constexpr double kDeviations = 3;  ///< half-width of the confidence interval in standard errors
/// The fewest lines that must be at least three times above the noise.
constexpr int kFewestLines = 8;
/// Systematic error, the same in every period, as a fraction of the response: geometry, the
/// directions of the strings as the grip moves, the time of an exchange.
constexpr double kSystematic = 0.005;
/// Noise cannot explain a larger misfit.
constexpr double kMaxMisfit = 3;
constexpr int kUnknowns = 5;  ///< the coefficients of the denominator, and the delay

struct LagCandidate {
  double lag_s = 0;
  double cost = std::numeric_limits<double>::infinity();  ///< chi²
  double error_s = 0;                                     ///< standard error of the lag
};

/// Returns T in (m s² + d s + k) (1 + T s) = a₃ s³ + a₂ s² + a₁ s + a₀, and the derivatives of T by
/// the coefficients. T is a root of a₃ − a₂ T + a₁ T² − a₀ T³. Newton's method finds it from a₃ /
/// a₂, the solution without a hand.
double first_order_part_s(const Eigen::Vector4d& a, Eigen::Vector4d& by_coefficient) {
  double part_s = a[3] / a[2];
  for (int i = 0; i < 20; ++i) {
    const double t = part_s;
    by_coefficient << -t * t * t, t * t, -t, 1;
    const double by_part = -a[2] + 2 * a[1] * t - 3 * a[0] * t * t;
    part_s -= a.dot(by_coefficient) / by_part;
    by_coefficient /= -by_part;
  }
  return part_s;
}

/// 1 / standard deviation of the real and of the imaginary part.
double weight_of(const ResponseLine& line, int periods) {
  // The variance is itself an estimate, which increases the expected chi² by this factor.
  const double estimated = static_cast<double>(periods - 1) / (periods - 2);
  const double systematic = kSystematic * kSystematic * std::norm(line.response);
  // Half of the variance belongs to the real part.
  return 1 / std::sqrt(0.5 * (estimated * line.variance + systematic));
}

/// The inverse of the response is linear in the coefficients, so linear least squares finds them.
/// The first pass weights errors by the measured response, the later passes by the fitted response
/// (Sanathanan and Koerner 1963).
LagCandidate best_with_delay(const std::vector<ResponseLine>& lines, int periods, double delay_s) {
  constexpr int kPasses = 4;
  LagCandidate found;
  Eigen::Vector4d a = Eigen::Vector4d::Zero();
  Eigen::Matrix4d normal;
  std::vector<std::complex<double>> model(lines.size());
  for (size_t i = 0; i < lines.size(); ++i) model[i] = lines[i].response;
  for (int pass = 0; pass < kPasses; ++pass) {
    normal.setZero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (size_t i = 0; i < lines.size(); ++i) {
      const double w = 2 * M_PI * lines[i].frequency_Hz;
      const std::complex<double> inverse = std::polar(1.0, -w * delay_s) / lines[i].response;
      const double weight = weight_of(lines[i], periods) * std::abs(model[i] * lines[i].response);
      const Eigen::Vector4d real(1, 0, -w * w, 0), imaginary(0, w, 0, -w * w * w);
      normal += weight * weight * (real * real.transpose() + imaginary * imaginary.transpose());
      right += weight * weight * (real * inverse.real() + imaginary * inverse.imag());
    }
    a = normal.ldlt().solve(right);
    found.cost = 0;
    for (size_t i = 0; i < lines.size(); ++i) {
      const double w = 2 * M_PI * lines[i].frequency_Hz;
      model[i] = std::polar(1.0, -w * delay_s) /
                 std::complex<double>(a[0] - a[2] * w * w, w * (a[1] - a[3] * w * w));
      found.cost += std::norm(weight_of(lines[i], periods) * (lines[i].response - model[i]));
    }
  }
  Eigen::Vector4d by_coefficient;
  found.lag_s = delay_s + first_order_part_s(a, by_coefficient);
  found.error_s = std::sqrt(by_coefficient.dot(normal.ldlt().solve(by_coefficient)));
  if (!(a[2] > 0) || !std::isfinite(found.lag_s + found.error_s + found.cost)) return {};
  return found;
}

bool stands_out(const ResponseLine& line) {
  return std::norm(line.response) > 9 * line.variance;
}

std::string error_of(const LagFit& fit) {
  const double vague_s = std::max(kVagueLag_s, kVagueLagFraction * fit.lag_s);
  if (!(fit.misfit <= kMaxMisfit)) {
    return formatted(
        "the grip did not move as a mass with a spring and a damper (misfit %.1f, at most %.0f); "
        "hold it still and loosely, at the centre",
        fit.misfit, kMaxMisfit);
  }
  if (!(fit.most_s - fit.least_s <= 2 * vague_s)) {
    return formatted(
        "the lag could be told to within %.1f ms only; hold the grip still and loosely, or use a "
        "larger force",
        500 * (fit.most_s - fit.least_s));
  }
  if (!(fit.most_s <= kLongestLag_s)) {
    return formatted("the drive may lag by more than %.0f ms: no surface should be touched with it",
                     1e3 * kLongestLag_s);
  }
  return {};
}

}  // namespace

LagFit fit_lag(const std::vector<ResponseLine>& lines, int periods) {
  LagFit result;
  if (std::count_if(lines.begin(), lines.end(), stands_out) < kFewestLines) {
    result.error =
        "the grip hardly moved with the force; hold it loosely, so that it can move, or use a "
        "larger force";
    return result;
  }
  // All lines count: selecting those with a large response would bias the result upwards.
  std::vector<LagCandidate> found;
  for (double delay_s = kShortestDelay_s; delay_s <= kScanTo_s; delay_s += kScan_s) {
    found.push_back(best_with_delay(lines, periods, delay_s));
  }
  const LagCandidate best =
      *std::min_element(found.begin(), found.end(),
                        [](const LagCandidate& a, const auto& b) { return a.cost < b.cost; });
  const double spread = best.cost / static_cast<double>(2 * lines.size() - kUnknowns);
  result.misfit = std::sqrt(spread);
  result.lag_s = result.least_s = result.most_s = best.lag_s;
  // The interval is that of a profile likelihood: it contains, for every delay, the lags whose cost
  // is within the limit. A misfit scales all errors up.
  const double scale = std::max(1.0, spread);
  for (const LagCandidate& candidate : found) {
    const double left = kDeviations * kDeviations - (candidate.cost - best.cost) / scale;
    if (!(left >= 0)) continue;
    const double either_s = std::sqrt(left * scale) * candidate.error_s;
    result.least_s = std::min(result.least_s, candidate.lag_s - either_s);
    result.most_s = std::max(result.most_s, candidate.lag_s + either_s);
  }
  result.error_s = (result.most_s - result.least_s) / (2 * kDeviations);
  result.error = error_of(result);
  return result;
}

}  // namespace spidar::selftest
