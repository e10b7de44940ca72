// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/motion_estimator.h"

#include <algorithm>
#include <cmath>

namespace spidar {
namespace {

/// Mean of ρ over the votes, see point_cost().
double mean_cost(const MotionModel& model, const BackgroundVotes& votes, double sigma_px) {
  double sum = 0;
  double all = 0;
  for (size_t i = 0; i < votes.points.size(); ++i) {
    sum += votes.weights[i] * point_cost(model, votes.points[i], sigma_px);
    all += votes.weights[i];
  }
  return all > 0 ? sum / all : 0;
}

/// Reductions leave out columns and rows at the right and at the bottom that do not fill a pixel:
/// the picture of the field begins where the frame does, and may end before it.
FieldPlace place_of(const BlockField& field, const ReducedFrame& reduced) {
  FieldPlace place;
  place.scale = reduced.factor() * field.scale();
  place.centre_px = {(place.scale * field.picture().width() - 1) / 2,
                     (place.scale * field.picture().height() - 1) / 2};
  return place;
}

}  // namespace

MotionEstimator::MotionEstimator() {
  votes_.reserve(kMostDisplacements);
  evidence_.points.reserve(kMostDisplacements);
  evidence_.weights.reserve(kMostDisplacements);
}

/// Refines the model with the windows that agree with it: blocks are accurate to a tenth of a
/// pixel, windows to a few hundredths of a pixel of the frame.
void MotionEstimator::refine_background(Background& background,
                                        const std::vector<FineMotion>& fine) {
  const ModelKind kind = background.model.kind;
  if (kind == ModelKind::kStill) return;
  evidence_.points.clear();
  const double reach_px = 2 * background.sigma_px;
  for (const FineMotion& window : fine) {
    const Eigen::Vector2d expected_px = background.model.displacement_px(window.from_px);
    if ((window.moved_px - expected_px).norm() < reach_px) {
      evidence_.points.push_back({0, window.from_px, window.moved_px});
    }
  }
  evidence_.weights.assign(evidence_.points.size(), 1.0);
  evidence_.sigma_px = kUsualNoise_px;
  const auto refined = fitter_.refine(kind, background.model, evidence_);
  if (!refined) return;
  // Far from the windows the refined model must agree with the old one.
  const double x_px = field_.picture().width() / 2.0;
  const double y_px = field_.picture().height() / 2.0;
  for (const Eigen::Vector2d& corner_px :
       {Eigen::Vector2d(-x_px, -y_px), Eigen::Vector2d(x_px, -y_px), Eigen::Vector2d(-x_px, y_px),
        Eigen::Vector2d(x_px, y_px)}) {
    const Eigen::Vector2d change_px =
        refined->displacement_px(corner_px) - background.model.displacement_px(corner_px);
    if (change_px.norm() > reach_px) return;
  }
  // It must also agree where the blocks are: many windows may lie on a single layer of a scene
  // with depth.
  const double dearer =
      mean_cost(*refined, votes_, reach_px / 2) - mean_cost(background.model, votes_, reach_px / 2);
  if (dearer > 0) return;
  background.model = *refined;
}

void MotionEstimator::keep_windows(const ImageView& frame, const FieldPlace& place) {
  const std::vector<uint32_t>& owners = objects_.owners();
  const bool camera_moves = estimator_.background().model.kind != ModelKind::kStill;
  wishes_.resize(field_.blocks().size());
  for (size_t i = 0; i < wishes_.size(); ++i) {
    const bool shows_background = camera_moves && !objects_.is_burned_in(i);
    wishes_[i] = i < owners.size() && owners[i] != 0 ? FineWish::kEach
                 : shows_background                  ? FineWish::kSome
                                                     : FineWish::kNone;
  }
  windows_.keep(frame, field_, place, wishes_);
}

/// Lists the blocks that show how they move as tracks; their number is the id.
void MotionEstimator::report_tracks(const FieldPlace& place, std::vector<Track>& tracks) const {
  tracks.clear();
  const auto scale = static_cast<float>(place.scale);
  const Eigen::Vector2f centre_px = place.centre_px.cast<float>();
  for (size_t i = 0; i < field_.blocks().size(); ++i) {
    const MotionBlock& block = field_.blocks()[i];
    const bool shows_motion =
        objects_.is_measured(i) ||
        static_cast<double>(block.weakest_texture()) >= MotionBlock::kLeastVoteTexture;
    if (!shows_motion) continue;
    const ImagePoint to{centre_px.x() + scale * block.x_px, centre_px.y() + scale * block.y_px};
    const ImagePoint from{to.x_px - scale * block.moved_x_px, to.y_px - scale * block.moved_y_px};
    tracks.push_back({static_cast<uint32_t>(i), from, to});
  }
}

bool MotionEstimator::estimate(const ImageView& image, const ReducedFrame& reduced,
                               MeasuredFrame& frame) {
  if (reduced.picture() == PictureKind::kSame && field_.has_picture()) {
    field_.stand_still();
  } else if (field_.update(reduced.base()) != BlockField::Result::kMoved) {
    estimator_.reset();
    objects_.reset();
    dominant_.reset();
    windows_.reset();
    frame.features = 0;
    return false;
  }
  const double interval_s = static_cast<double>(frame.interval_ns) * 1e-9;
  const FieldPlace place = place_of(field_, reduced);
  const std::vector<FineMotion>& fine = windows_.find(image, field_, place);
  collect_votes(field_, objects_.past(), votes_);
  Background background = estimator_.estimate(votes_);
  refine_background(background, fine);
  frame.background = in_pixels_of(background, place.scale);
  frame.votes = static_cast<int>(votes_.points.size());
  // The camera's motion needs them, too: blocks that move by themselves or are burned in have less
  // of a vote, or none.
  const Eigen::Vector2d middle_px((reduced.width() - 1) / 2.0, (reduced.height() - 1) / 2.0);
  const FieldInFrame in_frame{field_, place.scale, place.centre_px - middle_px, interval_s, fine};
  const std::vector<MovingObject>& objects = objects_.update(in_frame, background);
  estimator_.learn_noise(votes_, [this](size_t block) { return objects_.moves(block); });
  frame.objects = objects;
  const MovingObject* const dominant = dominant_.choose(objects, interval_s);
  frame.dominant = dominant ? dominant->id : 0;
  report_tracks(place, frame.tracks);
  keep_windows(image, place);
  frame.features = static_cast<int>(frame.tracks.size());
  return true;
}

void MotionEstimator::reset() {
  windows_.reset();
  field_.restart();
  estimator_.reset();
  objects_.reset();
  dominant_.reset();
}

}  // namespace spidar
