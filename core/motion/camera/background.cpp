// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/camera/background.h"

#include <algorithm>
#include <cmath>

#include "core/field/block_kernels.h"
#include "core/quantile.h"

namespace spidar {
namespace {

/// An object in front of a plain background hardly has more than this fraction of the votes.
constexpr double kMaxObject = 0.2;
/// If this fraction of all votes is cast, they cannot all be from two objects.
constexpr double kTexturedFraction = 2 * kMaxObject;

/// A vote that deviates by more than kOutlierSigmas times the noise of a displacement, and by at
/// least kMinReach_px of the picture in which motion is measured, is an outlier.
constexpr double kOutlierSigmas = 2.5;
constexpr double kMinReach_px = 0.45;

/// A model explains the votes when most of them are inliers and their mean ρ is below kExplained;
/// the ρ of an outlier is 4.
constexpr double kExplained = 0.3;

/// Two positions are connected if they are less than this apart in x and in y, px: blocks side by
/// side are kBlock_px apart.
constexpr double kConnected_px = 1.5 * kBlock_px;
/// An object, such as a half-visible person, is cut by at most this many borders of the picture. A
/// part of the scene with a straight edge, such as ground, ice or a wall, is cut by more.
constexpr int kMaxBorders = 1;

ModelKind next(ModelKind kind, int step) {
  return static_cast<ModelKind>(static_cast<int>(kind) + step);
}

}  // namespace

double vote_reach_px(double noise_px) {
  return std::max(kMinReach_px, kOutlierSigmas * noise_px);
}

double BackgroundVotes::sum() const {
  double votes = 0;
  for (const BackgroundVote& vote : cast) votes += vote.votes();
  return votes;
}

bool BackgroundVotes::are_few() const {
  return cast.size() < kMinVotes || sum() < kMaxObject * all;
}

bool BackgroundVotes::are_many() const {
  return cast.size() >= kMinVotes && sum() >= kTexturedFraction * all;
}

Background in_pixels_of(const Background& background, double scale) {
  Background result = background;
  result.model.shift_px *= scale;
  result.model.perspective_1_px /= scale;
  result.sigma_px *= scale;
  return result;
}

BackgroundEstimator::BackgroundEstimator() {
  evidence_.points.reserve(kMaxDisplacements);
  evidence_.weights.reserve(kMaxDisplacements);
  residuals_px_.reserve(kMaxDisplacements);
  positions_px_.reserve(kMaxDisplacements);
  known_.reserve(2);
  reset();
}

void BackgroundEstimator::reset() {
  background_ = Background();
  noise_px_ = kUsualNoise_px;
}

/// The weights are scaled so that their sum is the number of equally weighted points that carry the
/// same information (Kish's effective sample size). The GRIC can then be used unchanged.
void BackgroundEstimator::weigh(const BackgroundVotes& votes) {
  evidence_.points.clear();
  evidence_.weights.clear();
  evidence_.sigma_px = vote_reach_px(noise_px_) / 2;
  double sum = 0;
  double squares = 0;
  for (const BackgroundVote& vote : votes.cast) {
    evidence_.points.push_back(vote.point);
    evidence_.weights.push_back(vote.weight);
    sum += vote.weight;
    squares += vote.weight * vote.weight;
  }
  for (double& weight : evidence_.weights) weight *= sum / squares;
  effective_points_ = sum * sum / squares;
  voting_ = votes.sum();
  is_textured_ = voting_ >= kTexturedFraction * votes.all;
}

/// Removes all positions connected to `middle_px`, if together they are one object of any size.
void BackgroundEstimator::remove_connected_to(const Eigen::Vector2d& middle_px,
                                              const Eigen::Vector2d& size_px) {
  const auto middle = std::find(positions_px_.begin(), positions_px_.end(), middle_px);
  std::iter_swap(positions_px_.begin(), middle);
  const Eigen::Array2d inner_px = size_px.array() / 2 - kBlock_px;
  bool left = false, right = false, above = false, below = false;
  auto end = positions_px_.begin() + 1;  // of the connected positions
  for (auto it = positions_px_.begin(); it != end; ++it) {
    left |= it->x() < -inner_px.x();
    right |= it->x() > inner_px.x();
    above |= it->y() < -inner_px.y();
    below |= it->y() > inner_px.y();
    end = std::partition(end, positions_px_.end(), [&](const Eigen::Vector2d& other_px) {
      return (other_px - *it).cwiseAbs().maxCoeff() < kConnected_px;
    });
  }
  if (left + right + above + below > kMaxBorders) return;
  positions_px_.erase(positions_px_.begin(), end);
}

/// Whether positions_px_, which this function empties, belong to more than one object in front of a
/// plain background, or to more than two if the model is more general than a translation. That is
/// the case when kMinVotes are left after the objects have been removed. An object is a circle that
/// covers kMaxObject of the picture, around the position with which the circle contains the most
/// others. If all positions move alike, those connected to that position are removed as well.
bool BackgroundEstimator::is_background(ModelKind kind, bool move_alike,
                                        const Eigen::Vector2d& size_px) {
  const int objects = kind > ModelKind::kTranslation ? 2 : 1;
  const double radius_px2 = kMaxObject * size_px.prod() / M_PI;
  for (int n = 0; n < objects; ++n) {
    size_t most = 0;
    Eigen::Vector2d middle_px(0, 0);
    // Of many positions, only every n-th is tried, to bound the time.
    const size_t step = 1 + positions_px_.size() / kMaxTries;
    for (size_t i = 0; i < positions_px_.size(); i += step) {
      size_t near = 0;
      for (const Eigen::Vector2d& other_px : positions_px_) {
        near += (other_px - positions_px_[i]).squaredNorm() <= radius_px2;
      }
      if (near <= most) continue;
      most = near;
      middle_px = positions_px_[i];
    }
    if (positions_px_.size() < most + kMinVotes) return false;
    if (move_alike) remove_connected_to(middle_px, size_px);
    const auto is_its = [&](const Eigen::Vector2d& position_px) {
      return (position_px - middle_px).squaredNorm() <= radius_px2;
    };
    positions_px_.erase(std::remove_if(positions_px_.begin(), positions_px_.end(), is_its),
                        positions_px_.end());
    if (positions_px_.size() < kMinVotes) return false;
  }
  return true;
}

/// Whether the votes that agree with a model are of the background, and not of objects in front of
/// a plain one. Sets the model's coverage.
bool BackgroundEstimator::covers(Scored& scored, const BackgroundVotes& votes) {
  double sum = 0;
  positions_px_.clear();
  for (const BackgroundVote& vote : votes.cast) {
    if (point_cost(scored.model, vote.point, evidence_.sigma_px) >= kMaxCost) continue;
    sum += vote.votes();
    positions_px_.push_back(vote.point.at_px);
  }
  scored.coverage = votes.all > 0 ? sum / votes.all : 0;
  if (scored.model.kind == ModelKind::kStill || is_textured_ || votes.of_coarse_blocks) return true;
  if (is_background(scored.model.kind, true, votes.size_px)) return true;
  if (!of_objects_ || scored.coverage > of_objects_->coverage) of_objects_ = scored;
  return false;
}

/// Whether the chosen model is the camera's. It is if more of the votes agree with it than an
/// object can have, or if all other votes may be those of objects in front of a plain background,
/// unless most of the picture is new. Votes that move alike belong to one object and must not count
/// as several, so they are left out.
bool BackgroundEstimator::is_proven(const Scored& chosen, const BackgroundVotes& votes) {
  if (chosen.coverage * votes.all >= kMaxObject * voting_) return true;
  if (votes.with_edges || voting_ < kMaxObject * votes.all) return !votes.are_lost;
  positions_px_.clear();
  for (const BackgroundVote& vote : votes.cast) {
    const bool is_its =
        of_objects_ && point_cost(of_objects_->model, vote.point, evidence_.sigma_px) < kMaxCost;
    if (!is_its) positions_px_.push_back(vote.point.at_px);
  }
  return !is_background(ModelKind::kSimilarity, false, votes.size_px);
}

/// Returns false when the votes do not determine such a model, or it does not cover the picture.
bool BackgroundEstimator::score(ModelKind kind, const MotionModel& start,
                                const BackgroundVotes& votes, Scored& scored) {
  const auto model = fit_robustly(kind, start, evidence_);
  if (!model) return false;
  if (kind != ModelKind::kStill) ++fitted_;
  scored.model = *model;
  if (!covers(scored, votes)) return false;
  scored.cost = robust_cost(*model, evidence_);
  // The term λ₁ d n is the same for all models.
  scored.gric = scored.cost + std::log(4 * effective_points_) * parameters(kind);
  return true;
}

bool BackgroundEstimator::is_explained(const MotionModel& model) const {
  double inliers = 0;
  double outliers = 0;
  double cost = 0;
  for (size_t i = 0; i < evidence_.points.size(); ++i) {
    const double rho = point_cost(model, evidence_.points[i], evidence_.sigma_px);
    (rho < kMaxCost ? inliers : outliers) += evidence_.weights[i];
    if (rho >= kMaxCost) continue;
    cost += evidence_.weights[i] * rho;
  }
  return inliers > outliers && cost < kExplained * inliers;
}

/// Looks for a more general model that is better. Returns false when there is none.
bool BackgroundEstimator::find_more_general(const MotionModel& start, const BackgroundVotes& votes,
                                            Scored& current) {
  bool is_more_general = false;
  for (int model = static_cast<int>(current.model.kind) + 1; model < kModelKinds; ++model) {
    Scored higher;
    if (!score(static_cast<ModelKind>(model), start, votes, higher)) continue;
    if (higher.gric >= current.gric) continue;
    current = higher;
    is_more_general = true;
    if (is_explained(current.model)) break;
  }
  return is_more_general;
}

/// Goes back to a simpler model if it is better: the next simpler one, or 'still'.
void BackgroundEstimator::find_simpler(const MotionModel& start, const BackgroundVotes& votes,
                                       Scored& current) {
  Scored best = current;
  for (const ModelKind kind : {next(current.model.kind, -1), ModelKind::kStill}) {
    Scored lower;
    if (score(kind, start, votes, lower) && lower.gric < best.gric) best = lower;
    if (kind == ModelKind::kStill) break;
  }
  current = best;
}

/// Learns the noise as a median, because some moving objects may not have been recognised yet. If
/// few votes agree with the model, the picture is plain, or so blurred that the model is wrong; the
/// noise is then assumed to be that of good pictures. But if that model is rest and most of the
/// picture has texture, it is the noise that makes the votes disagree, and the noise is measured.
/// Nothing is learnt while the camera's motion is unknown.
void BackgroundEstimator::learn_noise() {
  if (!background_.is_known) return;
  double found_px = kUsualNoise_px;
  const bool is_textured_rest = is_textured_ && background_.model.kind == ModelKind::kStill;
  if (residuals_px_.size() >= kMinVotes &&
      (is_textured_rest || background_.coverage >= kMaxObject)) {
    found_px = median(residuals_px_.begin(), residuals_px_.end()) / kRayleighMedian;
  }
  noise_px_ += kNewestWeight * (std::max(found_px, kSharedError_px) - noise_px_);
}

Background BackgroundEstimator::propose(const BackgroundVotes& votes) {
  fitted_ = 0;
  of_objects_.reset();
  if (votes.cast.size() < kMinVotes) return {MotionModel(), noise_px_, 0, !votes.are_lost};
  weigh(votes);
  known_.assign({MotionModel(), background_.model});
  const MotionModel start = find_start(evidence_, known_);

  Scored current;
  if (!score(background_.model.kind, start, votes, current)) {
    score(ModelKind::kStill, start, votes, current);
  }
  const bool is_more_general =
      !is_explained(current.model) && find_more_general(start, votes, current);
  if (!is_more_general && current.model.kind != ModelKind::kStill) {
    find_simpler(start, votes, current);
  }
  if (!is_proven(current, votes)) return {MotionModel(), noise_px_, 0, false};
  return {current.model, noise_px_, current.coverage, true, votes.of_coarse_blocks};
}

}  // namespace spidar
