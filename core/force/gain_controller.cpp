// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/force/gain_controller.h"

#include <algorithm>
#include <cmath>

#include "core/motion/image_motion.h"
#include "core/require.h"

namespace spidar {

namespace {

/// Eq. 15.
double nonlinear_N(double max_force_N, double alpha_s_px, double speed_px_s) {
  return 2 * max_force_N / M_PI * std::atan(alpha_s_px * speed_px_s);
}

/// How far dx/dt = −clamp(x, −1, 1) / T brings an x ≥ 0 towards zero in a time t: with constant
/// speed down to 1, exponentially from there on.
double approach(double x, double t_over_T) {
  const double straight = std::max(0.0, x - 1);
  if (t_over_T <= straight) return t_over_T;
  return straight - std::min(x, 1.0) * std::expm1(straight - t_over_T);
}

}  // namespace

void validate(const ControllerSettings& settings) {
  require_not_negative("max_force_N", settings.max_force_N);
  require_not_negative("alpha_s_px", settings.alpha_s_px);
}

GainController::GainController(const ControllerSettings& settings) : settings_(settings) {
  validate(settings);
  reset();
}

void GainController::reset() {
  max_speed_px_s_ = 0;
  log_scale_ = -std::log(settings_.alpha_s_px);
}

void GainController::configure(const ControllerSettings& settings) {
  validate(settings);
  const bool is_other_law = settings.law != settings_.law;
  const bool is_other_scale = settings.alpha_s_px != settings_.alpha_s_px;
  settings_ = settings;
  // With α = 0 the scale was not adapted.
  if (is_other_law || (is_other_scale && std::isinf(log_scale_))) reset();
  if (is_other_scale) limit_scale();
}

void GainController::limit_scale() {
  const double middle = -std::log(settings_.alpha_s_px);
  log_scale_ = std::clamp(log_scale_, middle - std::log(kRange), middle + std::log(kRange));
}

double GainController::scale_px_s() const {
  return std::exp(log_scale_);
}

void GainController::adapt(double speed_px_s, double interval_s) {
  const double above = std::log(speed_px_s) - log_scale_;
  log_scale_ += above > 0 ? approach(above, interval_s / kAttack_s)
                          : -approach(-above, interval_s / kRelease_s);
  limit_scale();
}

double GainController::force_N(double speed_px_s, double interval_s, double dead_zone_px_s) {
  const double most_N = settings_.max_force_N;
  switch (settings_.law) {
    case ControlLaw::kLinear:
      max_speed_px_s_ = std::max(max_speed_px_s_, speed_px_s);
      // Dividing first gives exactly max_force_N at the largest speed, and no overflow of k.
      return max_speed_px_s_ > 0 ? most_N * (speed_px_s / max_speed_px_s_) : 0;
    case ControlLaw::kNonlinear:
      return nonlinear_N(most_N, settings_.alpha_s_px, speed_px_s);
    case ControlLaw::kAdaptive:
      break;
  }
  const double dead_px_s = dead_zone_px_s > 0 ? dead_zone_px_s : DeadZone::kUnknownError_px_s;
  if (settings_.alpha_s_px == 0 || speed_px_s <= dead_px_s) return 0;
  adapt(speed_px_s, interval_s);
  return nonlinear_N(most_N, 1 / scale_px_s(), speed_px_s - dead_px_s);
}

}  // namespace spidar
