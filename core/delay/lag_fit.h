// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The lag of a drive, from how a grip answers to a force.
#pragma once

#include <vector>

#include "core/api.h"
#include "core/delay/response_lines.h"

namespace spidar {

/// Why there is no lag.
enum class NoLag {
  kNone,      ///< there is one
  kNoMotion,  ///< the grip hardly answers to the force
  kNotAMass,  ///< it does not move as a mass with a spring and a damper
  kTooVague,  ///< the interval is too wide
  kTooLong,   ///< it may be longer than kLongestLag_s
};

struct LagFit {
  NoLag missing = NoLag::kNone;
  double lag_s = 0;    ///< the best
  double error_s = 0;  ///< its standard error
  /// No lag outside is believed, s: LagFitSettings::kDeviations standard errors either way.
  double least_s = 0;
  double most_s = 0;
  double mass_kg = 0;  ///< that moves along with the grip
  double damping_N_s_m = 0;
  double stiffness_N_m = 0;
  /// How far the response is from that of the model, as a multiple of what noise explains (the root
  /// of chi² per degree of freedom).
  double misfit = 0;
  int lines = 0;  ///< that stand out of the noise
};

/// Fits (D(jω) / (−mω² + jωd + k)) to the response: a rigid grip of mass m with the hand's spring
/// and damper, all of which answer to a force at once, behind the drive
/// D(jω) = exp(−jωτ) / (1 + jωT), a pure delay and a first-order lag in any proportion. The lag is
/// τ + T, the delay of D for slow motions; that is what a surface's damping has to make up for. It
/// is held apart from the damping because its phase grows with the frequency, and that of the
/// damping falls.
///
/// Assumed: no part of the grip or the hand that moves along with it resonates between 11 and
/// 83 Hz, and the strings do not stretch by much of what the grip moves. What speaks against it
/// appears as misfit.
class SPIDAR_API LagFitter {
 public:
  /// The interval has so many standard errors on either side: 99.7 %.
  static constexpr double kDeviations = 3;
  static constexpr double kLongestLag_s = 0.03;
  /// A wider interval is no measurement: this either way, or this share of the lag.
  static constexpr double kVague_s = 0.001;
  static constexpr double kVagueShare = 0.15;
  /// The least number of lines that stand out of the noise threefold.
  static constexpr int kFewestLines = 8;
  /// Errors of the response that do not differ from period to period, as a share of it: geometry,
  /// the strings' directions as the grip moves, the time of an exchange.
  static constexpr double kSystematic = 0.005;
  /// A misfit beyond this is no noise.
  static constexpr double kMostMisfit = 3;

  /// `periods`: that the lines are the average of.
  static LagFit fit(const std::vector<ResponseLine>& lines, int periods);
};

}  // namespace spidar
