// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/calibration/calibration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/grip/matrices.h"
#include "core/grip/pose_solver.h"
#include "core/quantile.h"
#include "spidar/calibration/model.h"
#include "spidar/calibration/samples.h"
#include "spidar/devices/sim/grip_model.h"
#include "spidar/text.h"

namespace spidar::calibration {
namespace {

constexpr int kMinStrings = 7;
constexpr int kMaxFitIterations = 50;
constexpr int kMaxRescalings = 5;
constexpr double kSameSigma = 0.02;
// A sample is an outlier if its residual exceeds 5 σ, as exp(−12.5), four in a million, of the good
// samples do.
constexpr double kOutlier = 5.0;
// After the strings have slipped, earlier offsets are no longer valid: most of the last tenth of
// the samples must fit.
constexpr Eigen::Index kLastParts = 10;

/// Estimates the standard deviation σ of one length from the norms of the samples' errors, up to
/// half of which may be arbitrary. The norm of a good sample is σ times the root of χ² with
/// `redundant` degrees of freedom, one or two. `parameters` is the number of fitted parameters.
/// Returns at least `floor_m`.
double robust_sigma_m(Eigen::VectorXd norms_m, int redundant, int parameters, double floor_m) {
  const double errors = redundant * static_cast<double>(norms_m.size());
  if (errors <= parameters) return floor_m;
  const double median_of_chi = redundant == 1 ? kNormalMedian : kRayleighMedian;
  const double left = std::sqrt((errors - parameters) / errors);
  return std::max(floor_m, median(norms_m.begin(), norms_m.end()) / median_of_chi / left);
}

struct Fit {
  const Model& model;
  const std::vector<StringVector>& lengths_m;
  Bundle bundle;
  double sigma_m = 0;        ///< standard deviation of one length
  Eigen::MatrixXd errors_m;  ///< a row for each sample, a column for each string
  Eigen::VectorXd norms_m;   ///< norm of the errors of each sample
  Eigen::VectorXd weights;   ///< Huber's weight of each sample

  int redundant() const { return model.strings() - 6; }

  void update_weights(double floor_m) {
    errors_m.resize(static_cast<Eigen::Index>(lengths_m.size()), model.strings());
    for (size_t k = 0; k < lengths_m.size(); ++k) {
      errors_m.row(static_cast<Eigen::Index>(k)) =
          model.length_errors_m(bundle.parameters, lengths_m[k], bundle.poses[k], nullptr);
    }
    norms_m = errors_m.rowwise().norm();
    sigma_m = robust_sigma_m(norms_m, redundant(), model.size(), floor_m);
    weights = (kHuber * sigma_m / norms_m.array().max(kHuber * sigma_m)).matrix();
  }

  /// The noise of all samples, in which outliers count with their weights.
  double noise_m(double floor_m) const {
    const double left = redundant() * weights.sum() - model.size();
    if (left <= 0) return floor_m;
    return std::max(floor_m, std::sqrt(weights.dot(norms_m.cwiseAbs2()) / left));
  }
};

/// Adapts the corner of Huber's function to the measured noise.
void refine(double floor_m, Fit& fit) {
  fit.update_weights(floor_m);
  for (int i = 0; i < kMaxRescalings; ++i) {
    const double before_m = fit.sigma_m;
    adjust(fit.model, fit.lengths_m, before_m, kMaxFitIterations, fit.bundle);
    fit.update_weights(floor_m);
    if (std::abs(fit.sigma_m - before_m) <= kSameSigma * before_m) break;
  }
}

/// The factor by which standard deviations grow because the errors of successive samples (rows) are
/// correlated, as those of a wrong model are. The factor is computed as for a first-order
/// autoregression with that correlation, and is 1 if the correlation may be chance.
double correlation_factor(const Fit& fit) {
  constexpr double kMaxCorrelation = 0.9999;
  const Eigen::MatrixXd weighted = fit.weights.asDiagonal() * fit.errors_m;
  const Eigen::Index pairs = weighted.rows() - 1;
  const double total = weighted.squaredNorm();
  if (pairs < 1 || !(total > 0)) return 1;
  const double product = weighted.topRows(pairs).cwiseProduct(weighted.bottomRows(pairs)).sum();
  const double correlation = product / total;
  // The correlation of independent errors stays below three standard deviations.
  const double chance = 3 / std::sqrt(static_cast<double>(fit.redundant() * pairs));
  if (correlation <= chance) return 1;
  const double bounded = std::min(correlation, kMaxCorrelation);
  return std::sqrt((1 + bounded) / (1 - bounded));
}

/// The standard deviation of the combination of parameters that the samples determine worst,
/// relative to that of a length, for independent errors of successive samples. Infinite if the
/// samples do not determine some combination at all. An orthogonal projection eliminates the pose
/// of each sample. The result is the square root of the Schur complement of bundle adjustment, and
/// remains accurate when the information matrix is singular.
double largest_sd(const Fit& fit) {
  // Singular values below this fraction of the largest one are rounding errors.
  constexpr double kRank = 1e-10;
  const Model& model = fit.model;
  const Eigen::Index left = fit.redundant(), samples = fit.errors_m.rows();
  Eigen::MatrixXd root =
      Eigen::MatrixXd::Zero(std::max<Eigen::Index>(model.size(), left * samples), model.size());
  for (Eigen::Index k = 0; k < samples; ++k) {
    const auto i = static_cast<size_t>(k);
    Model::Derivatives d;
    model.length_errors_m(fit.bundle.parameters, fit.lengths_m[i], fit.bundle.poses[i], &d);
    const Eigen::MatrixXd unexplained =
        singular_values(d.by_twist.transpose()).directions.rightCols(left);
    root.middleRows(left * k, left) =
        std::sqrt(fit.weights[k]) * unexplained.transpose() * d.by_parameter;
  }
  const Eigen::VectorXd told = singular_values(root).values;
  const double least = told[told.size() - 1];
  return least > kRank * told[0] ? 1 / least : std::numeric_limits<double>::infinity();
}

void describe_parameters(const Fit& fit, Result& result) {
  const Eigen::VectorXd& parameters = fit.bundle.parameters;
  const StringGeometry geometry = fit.model.geometry(parameters);
  result.home_offset_m = fit.model.home_offset_m(parameters);
  result.scale = fit.model.scale(parameters);
  result.exit_m = geometry.exit_m;
  result.cleared_at = pose_at_zero_count(geometry, result.home_offset_m);
}

void describe_motion(const std::vector<Pose>& poses, Result& result) {
  Eigen::AlignedBox3d positions, turns;
  for (const Pose& pose : poses) {
    positions.extend(pose.position_m);
    turns.extend(rotation_vector(pose.orientation));
  }
  result.moved_m = positions.sizes() / 2;
  result.turned_rad = turns.sizes() / 2;
}

/// Returns whether half of the samples have larger errors than are tolerable in a tick, or the last
/// samples do not fit.
bool contradicts(const Fit& fit, const Eigen::ArrayXd& outliers) {
  Eigen::VectorXd norms_m = fit.norms_m;
  const double typical_m = median(norms_m.begin(), norms_m.end()) / std::sqrt(fit.model.strings());
  const Eigen::Index last = (outliers.size() + kLastParts - 1) / kLastParts;
  return typical_m > PoseSolver::kMaxResidual_m || outliers.tail(last).mean() > 0.5;
}

}  // namespace

Result calibrate(const Profile& profile, const CountSamples& counts, const Settings& settings) {
  check_samples(profile, counts, kMinStrings);
  // The first fit estimates only the offsets, which are off by more than exits and scale.
  const Model offsets_only(profile, {});
  const std::vector<StringVector> lengths_m = distinct_lengths_m(offsets_only, counts);
  const double rounding_m = rounding_sd_m(
      profile, static_cast<double>(counts.rows()) / static_cast<double>(lengths_m.size()));
  const Model model(profile, settings);
  Fit fit{model, lengths_m, from_the_centre(offsets_only, lengths_m), 0, {}, {}, {}};
  fit.bundle.parameters.conservativeResizeLike(Eigen::VectorXd::Zero(model.size()));
  refine(rounding_m, fit);

  Result result;
  result.estimated = settings;
  result.samples = static_cast<int>(fit.errors_m.rows());
  result.residual_m = fit.errors_m.norm() / std::sqrt(static_cast<double>(fit.errors_m.size()));
  describe_parameters(fit, result);
  describe_motion(fit.bundle.poses, result);
  const double sd_m = fit.noise_m(rounding_m) * largest_sd(fit);
  const Eigen::ArrayXd outliers = (fit.norms_m.array() > kOutlier * fit.sigma_m).cast<double>();
  if (contradicts(fit, outliers)) {
    result.status = Status::kContradiction;
  } else if (!(sd_m <= kMaxSd_m)) {
    result.status = Status::kUndetermined;
  } else if (!(sd_m * correlation_factor(fit) <= kMaxSd_m)) {
    result.status = Status::kContradiction;
  } else {
    result.status = Status::kSolved;
  }
  return result;
}

Result calibrate_at_centre(const Profile& profile, const CountSamples& counts) {
  check_samples(profile, counts, 1);
  const Model model(profile, {});
  Result result;
  result.status = Status::kSolved;
  result.exit_m = profile.geometry.exit_m;
  result.samples = static_cast<int>(counts.rows());
  double squares_m2 = 0;
  for (int i = 0; i < model.strings(); ++i) {
    const double m_per_count = profile.drives[static_cast<size_t>(i)].metres_per_count;
    const Eigen::VectorXd held = counts.col(i);
    const double range_m = (held.maxCoeff() - held.minCoeff()) * m_per_count;
    if (range_m > kMaxHeldRange_m) {
      throw std::invalid_argument(
          "calibration: the grip was not held still: the length of string " + as_text(i) +
          " changed by " + as_text(1e3 * range_m) + " mm, must be less than " +
          as_text(1e3 * kMaxHeldRange_m) + " mm");
    }
    squares_m2 += (m_per_count * (held.array() - held.mean())).square().mean();
  }
  const Eigen::VectorXd mean = counts.colwise().mean();
  result.home_offset_m = -model.paid_out_m(mean);
  result.residual_m = std::sqrt(squares_m2 / model.strings());
  result.cleared_at = pose_at_zero_count(profile.geometry, result.home_offset_m);
  return result;
}

namespace {

void replace_provenance(const std::string& field, const std::string& how, const std::string& note,
                        std::vector<Provenance>& provenance) {
  const auto is_old = [&](const Provenance& row) {
    return row.field == field && row.evidence == Evidence::kMeasured;
  };
  provenance.erase(std::remove_if(provenance.begin(), provenance.end(), is_old), provenance.end());
  provenance.push_back({field, how, Evidence::kMeasured, note});
}

}  // namespace

Profile calibrated_profile(const Profile& profile, const Result& result, const std::string& how) {
  if (result.status != Status::kSolved) {
    throw std::invalid_argument("calibration: a result that is not solved makes no profile");
  }
  Profile calibrated = profile;
  calibrated.geometry.exit_m = result.exit_m;
  const auto count = static_cast<size_t>(profile.geometry.count);
  for (size_t i = 0; i < count; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    calibrated.drives[i].home_offset_m = result.home_offset_m[k];
    calibrated.drives[i].metres_per_count *= result.scale;
  }
  const std::string note =
      as_text(result.samples) + " samples, residual " + as_text(1e6 * result.residual_m) + " um";
  replace_provenance("home_offset_m", how, note, calibrated.provenance);
  if (result.estimated.free_scale) {
    replace_provenance("metres_per_count", how, note, calibrated.provenance);
  }
  if (result.estimated.free_exits) {
    replace_provenance("geometry", how, "exits; " + note, calibrated.provenance);
  }
  calibrated.calibration = CalibrationRecord{result.samples, result.residual_m};
  return calibrated;
}

}  // namespace spidar::calibration
