// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/calibration/calibration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "core/grip/pose_solver.h"
#include "spidar/calibration/bundle_adjustment.h"
#include "spidar/calibration/model.h"
#include "spidar/calibration/samples.h"
#include "spidar/calibration/uncertainty.h"
#include "spidar/profiles/toml_field.h"
#include "spidar/simulation/grip_model.h"

namespace spidar {
namespace {

constexpr int kMinStrings = 7;
constexpr int kMaxFitIterations = 50;
constexpr int kMaxRescalings = 5;
constexpr double kSameSigma = 0.02;
// exp(-12.5): four in a million of the good samples are outside.
constexpr double kOutlier = 5.0;
// If the strings slipped and stayed there, the earlier offsets are no longer valid: most of the
// last tenth of the samples must fit.
constexpr Eigen::Index kLastParts = 10;
// Coefficients of a combination that are printed.
constexpr double kShownShare = 0.3;
constexpr size_t kShownParts = 6;

/// The fitted parameters and their errors.
struct Fit {
  const CalibrationModel& model;
  const std::vector<StringVector>& lengths_m;
  Bundle bundle;
  double sigma_m = 0;        ///< standard deviation of one length
  Eigen::MatrixXd errors_m;  ///< a row for each sample, a column for each string
  Eigen::VectorXd norms_m;   ///< of the samples' errors
  Eigen::VectorXd weights;   ///< Huber's

  int redundant() const { return model.strings() - 6; }

  void look_at_errors(double floor_m) {
    errors_m.resize(static_cast<Eigen::Index>(lengths_m.size()), model.strings());
    for (size_t k = 0; k < lengths_m.size(); ++k)
      errors_m.row(static_cast<Eigen::Index>(k)) =
          model.length_errors_m(bundle.parameters, lengths_m[k], bundle.poses[k], nullptr);
    norms_m = errors_m.rowwise().norm();
    sigma_m = robust_sigma_m(norms_m, redundant(), model.size(), floor_m);
    weights = (kHuber * sigma_m / norms_m.array().max(kHuber * sigma_m)).matrix();
  }

  /// Noise of all samples; those in the tails count with their weights.
  double noise_m(double floor_m) const {
    const double left = redundant() * weights.sum() - model.size();
    if (left <= 0) return floor_m;
    return std::max(floor_m, std::sqrt(weights.dot(norms_m.cwiseAbs2()) / left));
  }
};

/// Adapts the corner of Huber's function to the noise that is found.
void refine(double floor_m, Fit& fit) {
  fit.look_at_errors(floor_m);
  for (int i = 0; i < kMaxRescalings; ++i) {
    const double before_m = fit.sigma_m;
    adjust(fit.model, fit.lengths_m, before_m, Adjust::kAll, kMaxFitIterations, fit.bundle);
    fit.look_at_errors(floor_m);
    if (std::abs(fit.sigma_m - before_m) <= kSameSigma * before_m) break;
  }
}

void remove_bias(double noise_m, double floor_m, Fit& fit) {
  fit.bundle.parameters -=
      noise_bias(fit.model, fit.lengths_m, noise_m, kMaxFitIterations, fit.bundle);
  adjust(fit.model, fit.lengths_m, fit.sigma_m, Adjust::kPoses, kMaxFitIterations, fit.bundle);
  fit.look_at_errors(floor_m);
}

/// The largest coefficients of a combination of named quantities, as text.
std::string combination_text(const CalibrationModel& model, const Eigen::VectorXd& coefficients) {
  const Eigen::VectorXd hundredths = (100 * coefficients).array().round().matrix();
  std::vector<int> order(static_cast<size_t>(coefficients.size()));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return std::abs(hundredths[a]) > std::abs(hundredths[b]); });
  const double least = kShownShare * std::abs(hundredths[order[0]]);
  std::string text;
  for (size_t n = 0; n < std::min(kShownParts, order.size()); ++n) {
    const double c = hundredths[order[n]];
    if (std::abs(c) < least) break;
    text += n == 0 ? (c < 0 ? "-" : "") : (c < 0 ? " - " : " + ");
    text += shown(std::abs(c) / 100) + " " + model.quantity_name(order[n]);
  }
  return text;
}

/// Computes the standard deviations of the estimates. Returns whether they would be small enough if
/// the errors of successive samples were independent.
bool find_observable(const Fit& fit, CalibrationResult& result) {
  const CalibrationModel& model = fit.model;
  Observability observability(model.size());
  for (size_t k = 0; k < fit.lengths_m.size(); ++k) {
    CalibrationModel::Derivatives d;
    model.length_errors_m(fit.bundle.parameters, fit.lengths_m[k], fit.bundle.poses[k], &d);
    observability.add(d.by_twist, d.by_parameter, fit.weights[static_cast<Eigen::Index>(k)]);
  }
  Observability::Directions directions = observability.directions();
  directions.sd *= result.length_noise_m;
  const bool motion_suffices = directions.sd.maxCoeff() <= kMaxCalibrationSd_m;
  directions.sd *= correlation_factor(fit.errors_m, fit.weights, fit.redundant());
  const Eigen::MatrixXd quantities = model.quantities();
  for (Eigen::Index i = 0; i < directions.sd.size(); ++i)
    if (directions.sd[i] > kMaxCalibrationSd_m)
      result.undetermined.push_back(
          {directions.sd[i], combination_text(model, quantities * directions.directions.col(i))});

  const Eigen::VectorXd sd = standard_deviations(directions, quantities);
  result.home_offset_sd_m.head(model.strings()) = sd.head(model.strings());
  if (model.scale_row() >= 0) result.scale_sd = sd[model.scale_row()] / model.mean_length_m();
  if (model.exit_row() >= 0)
    for (int i = 0; i < model.strings(); ++i)
      result.exit_sd_m.col(i) = sd.segment<3>(model.exit_row() + 3 * i);
  return motion_suffices;
}

void describe_parameters(const Fit& fit, CalibrationResult& result) {
  const Eigen::VectorXd& parameters = fit.bundle.parameters;
  const StringGeometry geometry = fit.model.geometry(parameters);
  result.home_offset_m = fit.model.home_offset_m(parameters);
  result.scale = fit.model.scale(parameters);
  result.exit_m = geometry.exit_m;
  result.cleared_at = pose_at_zero_count(geometry, result.home_offset_m);
}

void describe_motion(const std::vector<Pose>& poses, CalibrationResult& result) {
  using Range = Eigen::AlignedBox3d;
  Range positions, turns;
  for (const Pose& pose : poses) {
    positions.extend(pose.position_m);
    turns.extend(rotation_vector(pose.orientation));
  }
  result.moved_m = positions.sizes() / 2;
  result.turned_rad = turns.sizes() / 2;
}

void describe_errors(const Fit& fit, CalibrationResult& result) {
  const auto samples = static_cast<double>(fit.errors_m.rows());
  result.samples = static_cast<int>(fit.errors_m.rows());
  result.residual_m = fit.errors_m.norm() / std::sqrt(samples * fit.model.strings());
  result.string_residual_m.head(fit.model.strings()) =
      fit.errors_m.colwise().norm().transpose() / std::sqrt(samples);
}

/// Whether half of the samples have larger errors than are tolerable in a tick, or the last ones do
/// not fit.
bool contradicts(const Fit& fit, const Eigen::ArrayXd& outliers) {
  const double typical_m = median(fit.norms_m) / std::sqrt(fit.model.strings());
  const Eigen::Index last = (outliers.size() + kLastParts - 1) / kLastParts;
  return typical_m > PoseSolver::kMaxResidual_m || outliers.tail(last).mean() > 0.5;
}

}  // namespace

CalibrationResult calibrate(const Profile& profile, const CountSamples& counts,
                            const CalibrationSettings& settings) {
  check_samples(profile, counts, kMinStrings);
  // Only the offsets at first: a wrong start is much further off than the errors of exits and
  // scale.
  const CalibrationModel offsets_only(profile, {});
  const std::vector<StringVector> lengths_m = distinct_lengths_m(offsets_only, counts);
  const double rounding_m = rounding_sd_m(
      profile, static_cast<double>(counts.rows()) / static_cast<double>(lengths_m.size()));
  const CalibrationModel model(profile, settings);
  Fit fit{model, lengths_m, find_bundle(offsets_only, lengths_m, rounding_m), 0, {}, {}, {}};
  fit.bundle.parameters.conservativeResizeLike(Eigen::VectorXd::Zero(model.size()));
  refine(rounding_m, fit);

  CalibrationResult result;
  result.estimated = settings;
  result.length_noise_m = fit.noise_m(rounding_m);
  const bool motion_suffices = find_observable(fit, result);
  if (motion_suffices) remove_bias(result.length_noise_m, rounding_m, fit);
  result.home_offset_uncertainty_m = offset_uncertainty_m(model, lengths_m, fit.bundle, fit.weights,
                                                          result.length_noise_m, rounding_m);
  // Quantities that the motion does not determine get no value.
  result.home_offset_uncertainty_m =
      result.home_offset_uncertainty_m.cwiseMax(result.home_offset_sd_m);
  describe_parameters(fit, result);
  describe_motion(fit.bundle.poses, result);
  const Eigen::ArrayXd outliers = (fit.norms_m.array() > kOutlier * fit.sigma_m).cast<double>();
  result.outlier_share = outliers.mean();
  describe_errors(fit, result);

  if (contradicts(fit, outliers)) {
    result.status = CalibrationStatus::kContradiction;
  } else if (!motion_suffices) {
    result.status = CalibrationStatus::kUndetermined;
  } else if (!result.undetermined.empty()) {
    result.status = CalibrationStatus::kContradiction;
  } else {
    result.status = CalibrationStatus::kSolved;
  }
  return result;
}

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

Profile calibrated_profile(const Profile& profile, const CalibrationResult& result,
                           const std::string& how) {
  if (result.status != CalibrationStatus::kSolved)
    throw std::invalid_argument("calibration: a result that is not solved makes no profile");
  Profile calibrated = profile;
  calibrated.geometry.exit_m = result.exit_m;
  const auto count = static_cast<size_t>(profile.geometry.count);
  CalibrationRecord record;
  record.samples = result.samples;
  record.residual_m = result.residual_m;
  for (size_t i = 0; i < count; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    calibrated.drives[i].home_offset_m = result.home_offset_m[k];
    calibrated.drives[i].metres_per_count *= result.scale;
    record.home_offset_sd_m.push_back(result.home_offset_sd_m[k]);
  }
  const std::string note =
      shown(result.samples) + " samples, residual " + shown(1e6 * result.residual_m) + " um";
  replace_provenance("home_offset_m", how, note, calibrated.provenance);
  if (result.estimated.free_scale) {
    record.scale_sd = result.scale_sd;
    replace_provenance("metres_per_count", how, note, calibrated.provenance);
  }
  if (result.estimated.free_exits) {
    for (int i = 0; i < profile.geometry.count; ++i)
      record.exit_sd_m.push_back(result.exit_sd_m.col(i));
    replace_provenance("geometry", how, "exits; " + note, calibrated.provenance);
  }
  calibrated.calibration = record;
  return calibrated;
}

}  // namespace spidar
