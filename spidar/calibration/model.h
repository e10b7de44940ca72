// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// String lengths as a function of the grip's pose and of the calibration's parameters, and the fit
/// of both to measured lengths, with Ceres.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/grip/string_geometry.h"
#include "spidar/calibration/calibration.h"
#include "spidar/profiles/profile.h"

namespace spidar::calibration {

/// The parameters that all samples share, all in metres: an offset for each string; the scale minus
/// one, times the mean length at the centre; the exits along the directions that neither shift nor
/// turn the frame as a whole. (Lengths do not show the position of the frame, because moving all
/// exits and all poses together changes no length. Geodesy calls this choice "inner constraints".)
class Model {
 public:
  Model(const Profile& profile, const Settings& settings);

  int strings() const { return geometry_.count; }
  int size() const { return exits_at_ + static_cast<int>(exit_directions_.cols()); }

  StringGeometry geometry(const Eigen::VectorXd& parameters) const;

  double scale(const Eigen::VectorXd& parameters) const;

  StringVector home_offset_m(const Eigen::VectorXd& parameters) const;

  /// Change of the lengths since the counters were zero, with the scale of the profile.
  StringVector paid_out_m(const Eigen::VectorXd& counts) const;

  struct Derivatives {
    Eigen::Matrix<double, Eigen::Dynamic, 6> by_twist;  ///< [δp; δφ], φ a rotation vector in D
    Eigen::MatrixXd by_parameter;
  };

  /// Lengths at `pose` minus measured lengths. `derivatives` may be null.
  Eigen::VectorXd length_errors_m(const Eigen::VectorXd& parameters, const StringVector& paid_out_m,
                                  const Pose& pose, Derivatives* derivatives) const;

 private:
  StringGeometry geometry_;
  StringVector home_length_m_;
  StringVector metres_per_count_;  ///< signed
  double mean_length_m_;
  int scale_at_;
  int exits_at_;
  Eigen::MatrixXd exit_directions_;  ///< orthonormal columns
};

struct Bundle {
  Eigen::VectorXd parameters;
  std::vector<Pose> poses;  ///< one for each sample
};

/// Minimises Σ ρ(‖length errors of a sample‖² / σ²), starting from `bundle`. ρ is Huber's loss with
/// its corner at kHuber. When the strings of a sample contradict each other, all of them weigh
/// less, because eight lengths for six unknowns do not determine which string is at fault.
/// `paid_out_m` has one entry for each sample.
void adjust(const Model& model, const std::vector<StringVector>& paid_out_m, double sigma_m,
            int max_iterations, Bundle& bundle);

/// √5.99: 5 % of good samples exceed this norm, whose square / σ² is χ² of order two.
inline constexpr double kHuber = 2.448;

/// Returns a starting bundle, which follows the grip from a first sample at the centre.
Bundle from_the_centre(const Model& model, const std::vector<StringVector>& paid_out_m);

}  // namespace spidar::calibration
