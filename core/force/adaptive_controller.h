// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A controller whose gain follows the scene.
#pragma once

#include "core/force/gain_controller.h"

namespace spidar {

/// F = (2 Fmax / π) atan((V − V₀)⁺ / S): eq. 15 with 1/α = S, a running scale of the speeds seen,
/// and a dead zone V₀ that the force leaves without a step.
///
/// The dead zone is kNoiseSigmas standard errors of the velocity: for a Gaussian error of two
/// coordinates P(|e| > 3 σ) = 1.1 %. Where they are not known it is kLeast_px_s, the speed at which
/// eq. 15 with α = 0.01 and Fmax = 3 N gives 0.04 N, the smallest force that is felt (IEEE Trans.
/// Haptics 2013, PubMed 24808327). Within the dead zone the force is exactly zero and the scale
/// stays as it is, so that a pause does not make the controller more sensitive.
///
/// The scale follows ln V: d ln S / dt = clamp(ln V − ln S, −1, 1) / T, with T = kAttack_s while
/// speeds are above the scale and kRelease_s while they are below. It settles where a share of
/// about T_release / (T_attack + T_release) of the time is below it: an M-quantile (Breckling and
/// Chambers, Biometrika 75, 1988) of the logarithm, whose influence function is bounded. A single
/// outlier, however large, therefore raises the scale by a factor of at most exp(Δt / T) in a frame
/// of Δt; with eq. 12 it would weaken the rest of the film in proportion to its size. Each step is
/// the exact solution over its interval, so the result does not depend on the frame rate.
///
/// S starts at 1/α and stays within a factor of kRange of it, so that the noise of a film in which
/// hardly anything moves is not amplified.
class AdaptiveController final : public GainController {
 public:
  AdaptiveController(double max_force_N, double alpha_s_px);
  double force_N(const MeasuredSpeed& speed) override;
  void configure(const ControllerSettings& settings) override;
  void reset() override;

  /// S in px/s: the speed that gives half of the maximum force; infinite with α = 0.
  double scale_px_s() const;

  static constexpr double kNoiseSigmas = 3;
  static constexpr double kLeast_px_s = 2.1;  ///< tan(0.04 π / 6) / 0.01
  static constexpr double kAttack_s = 2;
  static constexpr double kRelease_s = 6;
  static constexpr double kRange = 10;

 private:
  void follow(double speed_px_s, double interval_s);
  void limit_scale();

  double max_force_N_;
  double alpha_s_px_;
  double log_scale_ = 0;  ///< ln S
};

}  // namespace spidar
