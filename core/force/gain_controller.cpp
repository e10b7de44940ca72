// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/force/gain_controller.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/force/adaptive_controller.h"
#include "core/require.h"

namespace spidar {

double LinearController::force_N(const MeasuredSpeed& measured) {
  const double speed_px_s = measured.speed_px_s;
  max_speed_px_s_ = std::max(max_speed_px_s_, speed_px_s);
  // The quotient first: exactly max_force_N at the largest speed, and no overflow of k.
  return max_speed_px_s_ > 0 ? max_force_N_ * (speed_px_s / max_speed_px_s_) : 0;
}

double LinearController::gain_N_s_px() const {
  return max_speed_px_s_ > 0 ? max_force_N_ / max_speed_px_s_ : 0;
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
  switch (settings.kind) {
    case ControllerKind::kLinear:
      return std::make_unique<LinearController>(settings.max_force_N);
    case ControllerKind::kNonlinear:
      return std::make_unique<NonlinearController>(settings.max_force_N, settings.alpha_s_px);
    case ControllerKind::kAdaptive:
      return std::make_unique<AdaptiveController>(settings.max_force_N, settings.alpha_s_px);
  }
  throw std::invalid_argument("there is no controller kind " +
                              std::to_string(static_cast<int>(settings.kind)));
}

Wrench render_motion(GainController& controller, const Eigen::Vector2d& velocity_px_s,
                     double interval_s, double noise_px_s) {
  const double speed_px_s = velocity_px_s.norm();
  const double force_N = controller.force_N({speed_px_s, interval_s, noise_px_s});
  Wrench wrench;
  if (speed_px_s > 0) {
    const Eigen::Vector2d direction = velocity_px_s / speed_px_s;
    wrench.force_N << force_N * direction.x(), -force_N * direction.y(), 0;
  }
  return wrench;
}

}  // namespace spidar
