// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <optional>
#include <vector>

#include "core/motion/camera/motion_models.h"

namespace spidar {

/// The votes of a block at the border of the picture, which counts as two blocks elsewhere, because
/// objects are rare there.
constexpr double kBorderVotes = 2;
/// The weight of the newest frame in values that are learnt from frame to frame.
constexpr double kNewestWeight = 0.4;
/// Fewer votes say nothing about the background.
constexpr size_t kMinVotes = 12;

/// The deviation, px of the field's picture, beyond which a vote is an outlier at this noise.
double vote_reach_px(double noise_px);

/// A displacement from which the camera's motion is estimated.
struct BackgroundVote {
  Displacement point;
  double weight = 1;  ///< > 0
  bool at_border = false;
  size_t source = 0;  ///< index for learn_noise()

  double votes() const { return at_border ? kBorderVotes : 1; }
};

struct BackgroundVotes {
  std::vector<BackgroundVote> cast;
  double all = 0;                 ///< votes of the whole picture, including its textureless parts
  Eigen::Vector2d size_px{1, 1};  ///< of the picture
  /// Whether edges vote, too. Edges of coding errors agree on no motion, which does not make the
  /// camera's motion unknown.
  bool with_edges = false;
  /// Whether votes are few because most of the picture is not found in the previous one, as in a
  /// fade while the camera moves fast. Then the background must not count as plain and at rest.
  bool are_lost = false;
  /// Whether the votes are of coarse blocks, which are so large that no object has several.
  bool of_coarse_blocks = false;

  /// Votes of all points together, without their weights.
  double sum() const;
  /// Whether all votes could be from a single object, or are too few for any model.
  bool are_few() const;
  /// Whether the votes are too many to be from two objects alone.
  bool are_many() const;
};

/// Returns `background` in smaller pixels, of which `scale` make one of the old.
Background in_pixels_of(const Background& background, double scale);

/// Finds the motion of the background, and thereby that of the camera. Keeps the kind of model of
/// the previous frame while this kind explains the votes, unless a simpler kind has a smaller GRIC.
/// Otherwise moves on to each more general kind with a smaller GRIC, until one explains the votes.
///
/// An object in front of a plain background may have all the votes, and any two objects move like
/// some similarity. When there are so few votes that two objects may have cast them all, a
/// translation needs votes in two positions that are too far apart for one object, and a more
/// general model needs them in three. Votes that agree and are connected belong to one object of
/// any size, unless two borders of the picture cut it. Rest needs no votes, because a plain
/// background casts none. But where there are votes in three positions, more than objects have, and
/// hardly any agrees with the model that explains them best, the camera's motion is unknown. It is
/// also unknown if votes are few because most of the picture is new.
///
/// Models compete by the GRIC (Torr: Geometric motion segmentation and model selection, Phil.
/// Trans. R. Soc. A 356, 1998): Σ w ρ(e²) + λ₁ d n + λ₂ k, ρ(e²) = min(e²/σ², λ₃ (r − d)), with r =
/// 4 coordinates of a pair, d = 2 for all models, k parameters, λ₁ = ln r, λ₂ = ln(r n), λ₃ = 2.
/// The model with the smallest value wins. More general models are only fitted in frames in which
/// the present one does not explain the votes.
class BackgroundEstimator {
 public:
  BackgroundEstimator();

  /// Estimates the background from the votes of one frame, without storing it.
  Background propose(const BackgroundVotes& votes);
  /// Stores the background for comparison with the next frame.
  const Background& store(const Background& background) { return background_ = background; }

  /// Learns the noise of the displacements from the votes on the stored background, for the next
  /// frame. Leaves out votes for which `moves(source)` is true: they move by themselves.
  template <typename Moves>
  void learn_noise(const BackgroundVotes& votes, Moves&& moves) {
    residuals_px_.clear();
    for (const auto& [point, weight, at_border, source] : votes.cast) {
      if (moves(source)) continue;
      const Eigen::Vector2d expected_px = background_.model.displacement_px(point.at_px);
      residuals_px_.push_back((point.moved_px - expected_px).norm());
    }
    learn_noise();
  }

  const Background& background() const { return background_; }

  /// For the tests and the benchmark: number of models that were fitted for the last frame.
  int fitted() const { return fitted_; }

  /// Call this after a cut or a seek.
  void reset();

 private:
  struct Scored {
    MotionModel model;
    double coverage = 0;
    double cost = 0;  ///< Σ w ρ
    double gric = 0;
  };

  void weigh(const BackgroundVotes& votes);
  bool covers(Scored& scored, const BackgroundVotes& votes);
  bool is_background(ModelKind kind, bool move_alike, const Eigen::Vector2d& size_px);
  void remove_connected_to(const Eigen::Vector2d& middle_px, const Eigen::Vector2d& size_px);
  bool is_proven(const Scored& chosen, const BackgroundVotes& votes);
  bool score(ModelKind kind, const MotionModel& start, const BackgroundVotes& votes,
             Scored& scored);
  bool is_explained(const MotionModel& model) const;
  bool find_more_general(const MotionModel& start, const BackgroundVotes& votes, Scored& current);
  void find_simpler(const MotionModel& start, const BackgroundVotes& votes, Scored& current);
  void learn_noise();

  WeightedDisplacements evidence_;
  std::vector<MotionModel> known_;
  std::vector<double> residuals_px_;
  std::vector<Eigen::Vector2d> positions_px_;  ///< of the votes that agree with a model
  std::optional<Scored> of_objects_;  ///< the model with most votes that is not the background's
  double effective_points_ = 0;
  double voting_ = 0;         ///< votes of all points together
  bool is_textured_ = false;  ///< whether most of the picture votes
  double noise_px_ = 0;
  int fitted_ = 0;
  Background background_;
};

}  // namespace spidar
