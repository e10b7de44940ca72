// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include "core/default_limits.h"

namespace spidar {

/// How a force follows from a speed.
enum class ControlLaw { kLinear, kNonlinear, kAdaptive };

struct ControllerSettings {
  ControlLaw law = ControlLaw::kNonlinear;
  double max_force_N = kDefaultForce_N;  ///< Fmax of eq. 12 and 15, finite and ≥ 0
  /// α of eq. 15, per px/s of the reference frame, finite and ≥ 0. The default was chosen on 50
  /// clips (docs/feeling.md, What can be told apart).
  double alpha_s_px = 0.0025;
};

/// Throws std::invalid_argument when a value is out of the range given in ControllerSettings.
void validate(const ControllerSettings& settings);

/// Converts speed to force. The paper's equations are one-dimensional; here they are applied to the
/// speed, and the force keeps the direction of the motion (their isotropic extension).
///
/// kLinear: F = k v, k = Fmax / Vmax(T), Vmax(T) the largest speed since reset() (eq. 11–13): k
/// never rises.
///
/// kNonlinear: F = (2 Fmax / π) atan(α V) (eq. 14–15).
///
/// kAdaptive: F = (2 Fmax / π) atan((V − V₀)⁺ / S): eq. 15 with 1/α = S, a running scale of the
/// past speeds, and a dead zone V₀ beyond which the force rises continuously from zero.
///
/// The dead zone is that of the motion, or DeadZone::kUnknownError_px_s where that is unknown.
/// Within the dead zone the force is exactly zero and the scale stays as it is, so that a pause
/// does not make the controller more sensitive.
///
/// The scale follows ln V: d ln S / dt = clamp(ln V − ln S, −1, 1) / T, with T = kAttack_s while
/// speeds are above the scale and kRelease_s while they are below. The scale settles where the
/// speed is below it for a fraction of about T_release / (T_attack + T_release) of the time: an
/// M-quantile (Breckling and Chambers, Biometrika 75, 1988) of the logarithm, whose influence
/// function is bounded. A single outlier, however large, therefore raises the scale by a factor of
/// at most exp(Δt / T) in a frame of Δt; with eq. 12 it would weaken the rest of the film in
/// proportion to its size. Each step is the exact solution over its interval, so the result does
/// not depend on the frame rate.
///
/// S starts at 1/α and stays within a factor of kRange of it, which limits how far a film without
/// much motion amplifies noise.
class GainController {
 public:
  explicit GainController(const ControllerSettings& settings);

  /// Returns the force for a speed, 0 … max_force_N. The scale may adapt to the speed, so call this
  /// once per frame, in order. `speed_px_s` ≥ 0 and `dead_zone_px_s` (see ImageMotion) are in px/s
  /// of the reference frame. `interval_s` is the running time since the previous frame. An interval
  /// or a dead zone of 0 is unknown.
  double force_N(double speed_px_s, double interval_s = 0, double dead_zone_px_s = 0);

  /// Changes the settings for later calls. Keeps the scale unless the law changes. Throws like
  /// validate().
  void configure(const ControllerSettings& settings);

  /// Resets the scale: after a flush or a discontinuity of the stream.
  void reset();

  /// S of kAdaptive, px/s: V₀ + S gives half of the maximum force; infinite with α = 0.
  double scale_px_s() const;

  static constexpr double kAttack_s = 2;
  static constexpr double kRelease_s = 6;
  static constexpr double kRange = 10;

 private:
  void adapt(double speed_px_s, double interval_s);
  void limit_scale();

  ControllerSettings settings_;
  double max_speed_px_s_ = 0;
  double log_scale_ = 0;  ///< ln S
};

}  // namespace spidar
