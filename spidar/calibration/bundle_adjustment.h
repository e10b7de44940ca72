// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Poses of all samples and shared parameters that fit measured lengths best, with Ceres.
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

/// Minimises Σ ρ(‖length errors of a sample‖² / σ²), from `bundle` on. ρ is Huber's with its corner
/// at kHuber: all strings of a sample count less when they contradict each other, because six
/// unknowns and eight lengths do not tell which one is at fault. `sigma_m` infinite: plain least
/// squares. `paid_out_m`: one for each sample.
void adjust(const CalibrationModel& model, const std::vector<StringVector>& paid_out_m,
            double sigma_m, Adjust what, int max_iterations, Bundle& bundle);

/// How far the parameters of `bundle`, which fits `paid_out_m` best, are off on average because the
/// poses are as noisy as the lengths: least squares with a pose for each sample is biased by the
/// noise squared, however many samples there are. By a parametric bootstrap (Efron and Tibshirani
/// 1993, ch. 10) with noise of `sigma_m` and its opposite, whose first-order effects cancel;
/// seeded, so that a result can be had again.
Eigen::VectorXd noise_bias(const CalibrationModel& model,
                           const std::vector<StringVector>& paid_out_m, double sigma_m,
                           int max_iterations, const Bundle& bundle);

/// √5.99: exceeded by 5 % of the good samples, whose squared error is χ² with two degrees of
/// freedom in units of σ².
inline constexpr double kHuber = 2.448;

}  // namespace spidar
