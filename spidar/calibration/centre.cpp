// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <cmath>
#include <limits>
#include <stdexcept>

#include "spidar/calibration/calibration.h"
#include "spidar/calibration/input.h"
#include "spidar/calibration/model.h"
#include "spidar/profiles/toml_field.h"

namespace spidar {

CalibrationResult calibrate_at_centre(const Profile& profile, const CountSamples& counts) {
  check_samples(profile, counts, 1);
  const CalibrationModel model(profile, {});
  CalibrationResult result;
  result.status = CalibrationStatus::kSolved;
  result.exit_m = profile.geometry.exit_m;
  result.samples = static_cast<int>(counts.rows());
  for (int i = 0; i < model.strings(); ++i) {
    const double m_per_count = profile.drives[static_cast<size_t>(i)].metres_per_count;
    const Eigen::VectorXd held = counts.col(i);
    const double range_m = (held.maxCoeff() - held.minCoeff()) * m_per_count;
    if (range_m > kMaxHeldRange_m)
      throw std::invalid_argument(
          "calibration: the grip was not held still: the length of string " + shown(i) +
          " changed by " + shown(1e3 * range_m) + " mm, must be less than " +
          shown(1e3 * kMaxHeldRange_m) + " mm");
    const double mean = held.mean();
    const double variance = (held.array() - mean).square().mean();
    result.home_offset_sd_m[i] = m_per_count * std::sqrt(variance + 1.0 / 12);
    result.string_residual_m[i] = m_per_count * std::sqrt(variance);
  }
  const Eigen::VectorXd mean = counts.colwise().mean();
  result.home_offset_m = -model.paid_out_m(mean);
  result.residual_m = result.string_residual_m.norm() / std::sqrt(model.strings());
  result.home_offset_uncertainty_m.head(model.strings())
      .setConstant(std::numeric_limits<double>::infinity());
  result.length_noise_m = result.home_offset_sd_m.head(model.strings()).mean();
  result.cleared_at = pose_at_zero_count(profile.geometry, result.home_offset_m);
  return result;
}

}  // namespace spidar
