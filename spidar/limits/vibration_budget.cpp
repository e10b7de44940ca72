// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/limits/vibration_budget.h"

#include <cmath>

#include "spidar/limits/safety_limits.h"

namespace spidar {
namespace {

// W_h of ISO 5349-1, exact values as in ISO 8041. Its low-pass of 1259 Hz, which removes 1.2 % at
// 500 Hz, the highest frequency here, is left out.
constexpr double kHighPass_rad_s = 2 * M_PI * 6.309573445;
constexpr double kHighPassQ = 0.7071067812;
constexpr double kTransition_rad_s = 100;
constexpr double kTransitionQ = 0.64;
/// Time constant of the mean squared acceleration: spreads out a jolt of a slow film. A strong
/// vibration still lowers the force at once, because a small fraction of its mean is enough.
constexpr double kMean_s = 2;
/// Added to the acceleration, m/s². The high-pass removes a constant, and the constant keeps the
/// states of a filter without input from becoming denormal numbers, which are slow.
constexpr double kOffset = 1e-6;
/// The most filter steps in one tick: 50 ms, twice the time constant of the high-pass.
constexpr int kMostSteps = 50;

}  // namespace

VibrationBudget::Section::Section(double n2, double n1, double n0, double omega_rad_s,
                                  double q) noexcept {
  const double k = 2 / kTick_s;
  const double c2 = k * k, c1 = k * omega_rad_s / q, c0 = omega_rad_s * omega_rad_s;
  const double scale = 1 / (c2 + c1 + c0);
  b0 = (n2 * k * k + n1 * k + n0) * scale;
  b1 = 2 * (n0 - n2 * k * k) * scale;
  b2 = (n2 * k * k - n1 * k + n0) * scale;
  a1 = 2 * (c0 - c2) * scale;
  a2 = (c2 - c1 + c0) * scale;
}

VibrationBudget::Six VibrationBudget::Section::process(const Six& in) noexcept {
  const Six out = b0 * in + s1;
  s1 = b1 * in - a1 * out + s2;
  s2 = b2 * in - a2 * out;
  return out;
}

VibrationBudget::VibrationBudget(double grip_radius_m) noexcept
    : transition_(0, kTransition_rad_s, kTransition_rad_s * kTransition_rad_s, kTransition_rad_s,
                  kTransitionQ),
      high_pass_(1, 0, 0, kHighPass_rad_s, kHighPassQ) {
  to_acceleration_.head<3>().setConstant(1 / kMoved_kg);
  to_acceleration_.tail<3>().setConstant(grip_radius_m > 0 ? 1 / (kMoved_kg * grip_radius_m) : 0);
}

void VibrationBudget::update(const Wrench& strings, double passed_s, int64_t now_ns) noexcept {
  if (!strings.is_finite()) return;
  Six given;
  given << strings.force_N.array(), strings.torque_Nm.array();
  // A force that is held for longer has no vibration left.
  due_s_ = std::min(due_s_ + non_negative(passed_s), kMostSteps * kTick_s);
  double squared_m2_s4 = 0, step_s = 0;
  for (; due_s_ > 0.5 * kTick_s; due_s_ -= kTick_s, step_s += kTick_s) {
    squared_m2_s4 +=
        high_pass_.process(transition_.process(given * to_acceleration_ + kOffset)).square().sum();
  }
  if (!(step_s > 0)) return;
  squared_m2_s4 *= kTick_s / step_s;

  const auto taken_ns = static_cast<int64_t>(1e9 / kRefill_m2_s4 * step_s * squared_m2_s4);
  full_at_ns_ = std::max(full_at_ns(), now_ns) + taken_ns;
  taken_ns_.store(taken_ns_.load(std::memory_order_relaxed) + taken_ns, std::memory_order_relaxed);
  const double empty_s = 1e-9 * static_cast<double>(full_at_ns_ - now_ns);
  const double left_m2_s3 = std::max(0.0, kStore_m2_s3 - kRefill_m2_s4 * empty_s);
  state_.left = 1 / kStore_m2_s3 * left_m2_s3;

  // The fraction is constant over a period of the vibration, so dividing by it gives the vibration
  // at full force.
  const double least_fraction = 1e-3;
  const double passed = std::max(state_.fraction, least_fraction);
  const double whole_m2_s4 = squared_m2_s4 / (passed * passed);
  mean_m2_s4_ += 1 / kMean_s * step_s * (whole_m2_s4 - mean_m2_s4_);
  most_m2_s4_ = std::max(mean_m2_s4_, most_m2_s4_ * (1 - 1 / kReturn_s * step_s));
  const double permitted_m2_s4 = std::max(kAlways_m2_s4, 1 / kEmptied_s * left_m2_s3);
  state_.fraction = most_m2_s4_ > permitted_m2_s4 ? std::sqrt(permitted_m2_s4 / most_m2_s4_) : 1;
}

}  // namespace spidar
