// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/conformance/lag_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <Eigen/Dense>

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

namespace {

using Complex = std::complex<double>;

constexpr double kNone = std::numeric_limits<double>::infinity();
/// The pure delay is negative if a board reads its counters later in an exchange than it sets its
/// output voltages. The simulation has a negative delay because of its time steps.
constexpr double kShortestDelay_s = -0.001;
constexpr double kScan_s = 0.0005;
/// Beyond kLongestLag_s, so that a lag that is too long is recognized.
constexpr double kScanTo_s = 2 * LagFitter::kLongestLag_s;
/// Step between the first-order parts that are tried: the larger of this time and this share of the
/// part.
constexpr double kPart_s = 0.00025;
constexpr double kPartShare = 0.1;
/// Number of subdivisions between the two neighbours of the best part.
constexpr int kFiner = 20;

struct Weighed {
  double rate_rad_s = 0;
  Complex response;
  double weight = 0;  ///< 1 / standard deviation of the real and of the imaginary part
};

/// Mass, damping and stiffness.
using GripParameters = Eigen::Vector3d;

struct LagCandidate {
  double part_s = 0;  ///< first-order part of the lag
  double lag_s = 0;
  GripParameters grip = GripParameters::Zero();
  double cost = kNone;  ///< chi²
  double error_s = 0;   ///< standard error of the lag for this part
};

Complex drive(double rate_rad_s, double part_s, double lag_s) {
  const Complex j(0, 1);
  return std::exp(-j * (rate_rad_s * (lag_s - part_s))) / (1.0 + j * (rate_rad_s * part_s));
}

/// The best grip for a given lag, and its cost. The response is not linear in mass, damping and
/// stiffness, its inverse is: linear least squares on that, in which the first pass weighs errors
/// by the measured response, and the others by the response of the grip that was found (Sanathanan
/// and Koerner 1963).
LagCandidate best_grip(const std::vector<Weighed>& lines, double part_s, double lag_s) {
  constexpr int kPasses = 3;
  LagCandidate found{part_s, lag_s};
  std::vector<Complex> model(lines.size());
  for (size_t i = 0; i < lines.size(); ++i) model[i] = lines[i].response;
  for (int pass = 0; pass < kPasses; ++pass) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    GripParameters right = GripParameters::Zero();
    for (size_t i = 0; i < lines.size(); ++i) {
      const double w = lines[i].rate_rad_s;
      const Complex through = drive(w, part_s, lag_s);
      const Complex inverse = through / lines[i].response;
      const double weight = lines[i].weight * std::abs(model[i] * lines[i].response / through);
      const GripParameters real(-w * w, 0, 1), imaginary(0, w, 0);
      normal += weight * weight * (real * real.transpose() + imaginary * imaginary.transpose());
      right += weight * weight * (real * inverse.real() + imaginary * inverse.imag());
    }
    found.grip = normal.ldlt().solve(right);
    found.cost = 0;
    for (size_t i = 0; i < lines.size(); ++i) {
      const double w = lines[i].rate_rad_s;
      model[i] = drive(w, part_s, lag_s) /
                 Complex(found.grip[2] - found.grip[0] * w * w, found.grip[1] * w);
      found.cost += std::norm(lines[i].weight * (lines[i].response - model[i]));
    }
  }
  if (!(found.grip[0] > 0)) found.cost = kNone;
  return found;
}

/// The best fit with this first-order part. Its cost is kNone if there is no valid one.
LagCandidate best_with(const std::vector<Weighed>& lines, double part_s) {
  constexpr double kFinest_s = 1e-7;
  const double shortest_s = part_s + kShortestDelay_s;
  LagCandidate best;
  best.part_s = part_s;
  for (double lag_s = shortest_s; lag_s <= kScanTo_s; lag_s += kScan_s) {
    const LagCandidate candidate = best_grip(lines, part_s, lag_s);
    if (candidate.cost < best.cost) best = candidate;
  }
  // A parabola through the costs around the best one, again and again. A lag that is off by its
  // standard error costs one more.
  for (double step_s = kScan_s / 2; std::isfinite(best.cost) && step_s > kFinest_s; step_s /= 4) {
    const double below = best_grip(lines, part_s, best.lag_s - step_s).cost;
    const double above = best_grip(lines, part_s, best.lag_s + step_s).cost;
    const double bend = below - 2 * best.cost + above;
    if (!std::isfinite(bend) || !(bend > 0)) break;
    const double error_s = step_s * std::sqrt(2 / bend);
    const double change_s = std::clamp(0.5 * step_s * (below - above) / bend, -step_s, step_s);
    const LagCandidate candidate = best_grip(lines, part_s, best.lag_s + change_s);
    if (candidate.cost <= best.cost) best = candidate;
    best.error_s = error_s;
    if (error_s > step_s) break;
  }
  if (!(best.lag_s >= shortest_s)) best.cost = kNone;
  return best;
}

bool is_better(const LagCandidate& a, const LagCandidate& b) {
  return a.cost < b.cost;
}

std::vector<LagCandidate> candidates_of(const std::vector<Weighed>& lines) {
  std::vector<LagCandidate> found;
  for (double part_s = 0; part_s <= LagFitter::kLongestLag_s;
       part_s += std::max(kPart_s, kPartShare * part_s))
    found.push_back(best_with(lines, part_s));
  const auto best = std::min_element(found.begin(), found.end(), is_better);
  const double from_s = (best == found.begin() ? best : best - 1)->part_s;
  const double to_s = (best + 1 == found.end() ? best : best + 1)->part_s;
  for (int i = 1; i < kFiner; ++i)
    found.push_back(best_with(lines, from_s + (to_s - from_s) * i / kFiner));
  return found;
}

bool stands_out(const ResponseLine& line) {
  return std::norm(line.response) > 9 * line.variance;
}

std::vector<Weighed> weigh(const std::vector<ResponseLine>& lines, int periods) {
  // The variance is itself an estimate, which increases the expected chi² by this factor.
  const double estimated = static_cast<double>(periods - 1) / (periods - 2);
  std::vector<Weighed> weighed;
  for (const ResponseLine& line : lines) {
    const double systematic =
        LagFitter::kSystematic * LagFitter::kSystematic * std::norm(line.response);
    // Half of the variance belongs to the real part.
    const double variance = 0.5 * (estimated * line.variance + systematic);
    weighed.push_back({2 * M_PI * line.frequency_Hz, line.response, 1 / std::sqrt(variance)});
  }
  return weighed;
}

}  // namespace

LagFit LagFitter::fit(const std::vector<ResponseLine>& lines, int periods) {
  LagFit result;
  result.lines = static_cast<int>(std::count_if(lines.begin(), lines.end(), stands_out));
  if (result.lines < kFewestLines) {
    result.missing = NoLag::kNoMotion;
    return result;
  }
  // Uses all lines: selecting those with a large response would bias the result upwards.
  const std::vector<LagCandidate> found = candidates_of(weigh(lines, periods));
  const LagCandidate best = *std::min_element(found.begin(), found.end(), is_better);
  if (!std::isfinite(best.cost)) {
    result.missing = NoLag::kNotAMass;
    return result;
  }
  constexpr int kUnknowns = 5;
  const double spread = best.cost / static_cast<double>(2 * lines.size() - kUnknowns);
  result.misfit = std::sqrt(spread);
  result.lag_s = result.least_s = result.most_s = best.lag_s;
  result.mass_kg = best.grip[0];
  result.damping_N_s_m = best.grip[1];
  result.stiffness_N_m = best.grip[2];
  // Profile likelihood: for every first-order part, the lags whose cost is within the limit. A
  // misfit scales all errors up.
  const double scale = std::max(1.0, spread);
  for (const LagCandidate& candidate : found) {
    const double left = kDeviations * kDeviations - (candidate.cost - best.cost) / scale;
    if (!(left >= 0)) continue;
    const double either_s = std::sqrt(left * scale) * candidate.error_s;
    result.least_s = std::min(result.least_s, candidate.lag_s - either_s);
    result.most_s = std::max(result.most_s, candidate.lag_s + either_s);
  }
  result.error_s = (result.most_s - result.least_s) / (2 * kDeviations);
  const double vague_s = std::max(kVague_s, kVagueShare * result.lag_s);
  if (!(result.misfit <= kMostMisfit)) {
    result.missing = NoLag::kNotAMass;
  } else if (!(result.most_s - result.least_s <= 2 * vague_s)) {
    result.missing = NoLag::kTooVague;
  } else if (!(result.most_s <= kLongestLag_s)) {
    result.missing = NoLag::kTooLong;
  }
  return result;
}

}  // namespace spidar
