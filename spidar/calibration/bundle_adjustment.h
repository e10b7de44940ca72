// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Fits the poses of all samples and the shared parameters to measured lengths, with Ceres, from a
/// start that it finds.
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

enum class Adjust { kPoses, kAll };

/// Minimises Σ ρ(‖length errors of a sample‖² / σ²), starting from `bundle`. ρ is Huber's loss with
/// its corner at kHuber. All strings of a sample have less weight if they contradict each other,
/// because six unknowns and eight lengths do not determine which string is at fault. With an
/// infinite `sigma_m`, this is plain least squares. `paid_out_m` has one entry for each sample.
void adjust(const CalibrationModel& model, const std::vector<StringVector>& paid_out_m,
            double sigma_m, Adjust what, int max_iterations, Bundle& bundle);

/// √5.99: exceeded by 5 % of the good samples, whose squared error is χ² with two degrees of
/// freedom in units of σ².
inline constexpr double kHuber = 2.448;

/// Fits some forty evenly spread samples with plain least squares from several starts. The best fit
/// is used to find the poses of the other samples. Wrong minima are recognised by their residual,
/// which is a hundred times that of the right one; it cannot be predicted which start leads to the
/// right one. The search ends at a residual (root mean square over strings) below `sure_m`, which
/// only the right minimum has.
Bundle find_bundle(const CalibrationModel& model, const std::vector<StringVector>& paid_out_m,
                   double sure_m);

}  // namespace spidar
