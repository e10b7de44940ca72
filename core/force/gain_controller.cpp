// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/force/gain_controller.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/motion/image_motion.h"
#include "core/require.h"

namespace spidar {

double LinearController::force_N(const MeasuredSpeed& measured) {
  const double speed_px_s = measured.speed_px_s;
  max_speed_px_s_ = std::max(max_speed_px_s_, speed_px_s);
  // The quotient first: exactly max_force_N at the largest speed, and no overflow of k.
  return max_speed_px_s_ > 0 ? max_force_N_ * (speed_px_s / max_speed_px_s_) : 0;
}

double NonlinearController::force_N(const MeasuredSpeed& measured) {
  return 2 * max_force_N_ / M_PI * std::atan(alpha_s_px_ * measured.speed_px_s);
}

void validate(const ControllerSettings& settings) {
  require_not_negative("max_force_N", settings.max_force_N);
  require_not_negative("alpha_s_px", settings.alpha_s_px);
}

std::unique_ptr<GainController> make_controller(const ControllerSettings& settings) {
  validate(settings);
  switch (settings.law) {
    case ControlLaw::kLinear:
      return std::make_unique<LinearController>(settings.max_force_N);
    case ControlLaw::kNonlinear:
      return std::make_unique<NonlinearController>(settings.max_force_N, settings.alpha_s_px);
    case ControlLaw::kAdaptive:
      return std::make_unique<AdaptiveController>(settings.max_force_N, settings.alpha_s_px);
  }
  throw std::invalid_argument("there is no controller kind " +
                              std::to_string(static_cast<int>(settings.law)));
}

namespace {

/// How far dx/dt = −clamp(x, −1, 1) / T brings an x ≥ 0 towards zero in a time t: with constant
/// speed down to 1, exponentially from there on.
double approach(double x, double t_over_T) {
  const double straight = std::max(0.0, x - 1);
  if (t_over_T <= straight) return t_over_T;
  return straight - std::min(x, 1.0) * std::expm1(straight - t_over_T);
}

}  // namespace

AdaptiveController::AdaptiveController(double max_force_N, double alpha_s_px)
    : max_force_N_(max_force_N), alpha_s_px_(alpha_s_px) {
  reset();
}

void AdaptiveController::reset() {
  log_scale_ = -std::log(alpha_s_px_);
}

void AdaptiveController::configure(const ControllerSettings& settings) {
  max_force_N_ = settings.max_force_N;
  if (settings.alpha_s_px == alpha_s_px_) return;
  alpha_s_px_ = settings.alpha_s_px;
  if (std::isinf(log_scale_)) reset();  // α was 0: nothing was learnt
  limit_scale();
}

void AdaptiveController::limit_scale() {
  const double middle = -std::log(alpha_s_px_);
  log_scale_ = std::clamp(log_scale_, middle - std::log(kRange), middle + std::log(kRange));
}

double AdaptiveController::scale_px_s() const {
  return std::exp(log_scale_);
}

void AdaptiveController::adapt(double speed_px_s, double interval_s) {
  const double above = std::log(speed_px_s) - log_scale_;
  log_scale_ += above > 0 ? approach(above, interval_s / kAttack_s)
                          : -approach(-above, interval_s / kRelease_s);
  limit_scale();
}

double AdaptiveController::force_N(const MeasuredSpeed& measured) {
  const double dead_px_s =
      measured.dead_zone_px_s > 0 ? measured.dead_zone_px_s : DeadZone::kLeast_px_s;
  if (alpha_s_px_ == 0 || measured.speed_px_s <= dead_px_s) return 0;
  adapt(measured.speed_px_s, measured.interval_s);
  return NonlinearController(max_force_N_, 1 / scale_px_s())
      .force_N(measured.speed_px_s - dead_px_s);
}

}  // namespace spidar
