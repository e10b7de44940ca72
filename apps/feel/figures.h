// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Statistics of what a hand would notice of a film.
#pragma once

#include <vector>

#include "apps/feel/film.h"
#include "core/analysis/no_force_reason.h"
#include "core/force/gain_controller.h"
#include "core/force/motion_filter.h"

namespace spidar {

/// The Weber fraction of force, approximately as in the paper from which kFeltForce_N is taken.
constexpr double kWeberFraction = 0.10;
/// A slower motion does not count as moving, px/s of a frame 480 lines high.
constexpr double kMoving_px_s = 1;
constexpr double kAtLimit = 0.95;  ///< of the maximum force

/// Statistics of a film; shares are of the time in which something moves, 0 … 1.
struct FeelFigures {
  double moving = 0;      ///< share of the whole film
  double felt = 0;        ///< the force is at least kFeltForce_N
  double at_limit = 0;    ///< the force is at least kAtLimit of the maximum: speeds feel alike
  double told_apart = 0;  ///< the force differs from that of the previous frame by more than …
                          ///< … kWeberFraction of the larger one, and by kFeltForce_N
  double rank = 0;  ///< Spearman's correlation between the visible speed and the size of the force
  double mean_force_N = 0;  ///< while something moves
};

/// Filters the film and applies a controller to it, frame by frame as the element does.
FeelFigures feel(const Film& film, const FilterSettings& filter,
                 const ControllerSettings& controller);

/// Spearman's rank correlation of two lists of the same length; equal values share their mean rank.
/// 0 when all of `a` or all of `b` are equal.
double rank_correlation(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace spidar
