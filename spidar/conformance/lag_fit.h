// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Estimates the lag of a drive from the response of a grip to a force.
#pragma once

#include <vector>

#include "spidar/conformance/response_lines.h"

namespace spidar {

/// Why a fit has no result.
enum class NoLag {
  kNone,      ///< there is a result
  kNoMotion,  ///< the grip hardly responds to the force
  kNotAMass,  ///< it does not move as a mass with a spring and a damper
  kTooVague,  ///< the interval is too wide
  kTooLong,   ///< it may be longer than kLongestLag_s
};

struct LagFit {
  NoLag missing = NoLag::kNone;
  double lag_s = 0;    ///< best estimate
  double error_s = 0;  ///< standard error of lag_s
  /// Confidence interval: LagFitter::kDeviations standard errors to either side.
  double least_s = 0;
  double most_s = 0;
  double mass_kg = 0;  ///< of the grip and what moves with it
  double damping_N_s_m = 0;
  double stiffness_N_m = 0;
  /// Deviation of the response from the model, relative to the noise: the square root of chi² per
  /// degree of freedom.
  double misfit = 0;
  int lines = 0;  ///< number of lines above the noise
};

/// Fits D(jω) / (−mω² + jωd + k) to the response. The model is a rigid grip of mass m with the
/// spring k and damper d of the hand, driven through D(jω) = exp(−jωτ) / (1 + jωT), a pure delay
/// and a first-order lag in any proportion. The lag is τ + T, the low-frequency delay of D, which
/// the damping of a surface has to compensate. It can be distinguished from the damping because its
/// phase grows with frequency while that of the damping falls.
///
/// The model assumes that neither the grip nor the hand resonates between 11 and 83 Hz, and that
/// the strings stretch little compared with the motion of the grip. A violation appears as misfit.
class LagFitter {
 public:
  /// Half-width of the confidence interval in standard errors: 99.7 %.
  static constexpr double kDeviations = 3;
  static constexpr double kLongestLag_s = 0.03;
  /// Largest half-width of a usable interval: the larger of this time and this share of the lag.
  static constexpr double kVague_s = 0.001;
  static constexpr double kVagueShare = 0.15;
  /// The minimum number of lines at least three times above the noise.
  static constexpr int kFewestLines = 8;
  /// Systematic error, the same in every period, as a share of the response: geometry, the
  /// directions of the strings as the grip moves, the time of an exchange.
  static constexpr double kSystematic = 0.005;
  /// A larger misfit cannot be explained by noise.
  static constexpr double kMostMisfit = 3;

  /// `periods` is the number of periods that the lines average.
  static LagFit fit(const std::vector<ResponseLine>& lines, int periods);
};

}  // namespace spidar
