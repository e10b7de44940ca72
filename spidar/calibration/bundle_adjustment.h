// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Fits the poses of all samples and the shared parameters to measured lengths, with Ceres.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/grip/pose.h"
#include "spidar/calibration/model.h"

namespace spidar {

struct Bundle {
  Eigen::VectorXd parameters;  ///< of the model
  std::vector<Pose> poses;     ///< one for each sample
};

/// Minimises Σ ρ(‖length errors of a sample‖² / σ²), starting from `bundle`. ρ is Huber's loss with
/// its corner at kHuber. All strings of a sample have less weight if they contradict each other,
/// because six unknowns and eight lengths do not determine which string is at fault. `paid_out_m`
/// has one entry for each sample.
void adjust(const CalibrationModel& model, const std::vector<StringVector>& paid_out_m,
            double sigma_m, int max_iterations, Bundle& bundle);

/// √5.99: exceeded by 5 % of the good samples, whose squared error is χ² with two degrees of
/// freedom in units of σ².
inline constexpr double kHuber = 2.448;

/// A start: takes the first sample for one at the centre, and follows the grip from there.
Bundle from_the_centre(const CalibrationModel& model, const std::vector<StringVector>& paid_out_m);

}  // namespace spidar
