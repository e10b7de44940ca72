// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/motion_estimator.h"

namespace spidar {
namespace {

/// Reductions leave out columns and rows at the right and at the bottom that do not fill a pixel:
/// the picture of the field begins where the frame does, and may end before it.
FieldPosition position_of(const BlockField& field, const ReducedFrame& reduced) {
  FieldPosition position;
  position.scale = reduced.factor() * field.scale();
  position.centre_px = {(position.scale * field.picture().width() - 1) / 2,
                        (position.scale * field.picture().height() - 1) / 2};
  return position;
}

}  // namespace

void MotionEstimator::store_windows(const ImageView& frame, const FieldPosition& position) {
  const std::vector<uint32_t>& owners = objects_.owners();
  of_objects_.reserve(owners.size());
  of_objects_.clear();
  for (size_t i = 0; i < owners.size(); ++i) {
    if (owners[i] != 0) of_objects_.push_back(i);
  }
  windows_.store(frame, field_, position, of_objects_);
}

/// Lists the blocks that show how they move as points; the id is the index of the block.
void MotionEstimator::report_points(const FieldPosition& position,
                                    std::vector<FollowedPoint>& points) const {
  points.clear();
  const auto scale = static_cast<float>(position.scale);
  const Eigen::Vector2f centre_px = position.centre_px.cast<float>();
  for (size_t i = 0; i < field_.blocks().size(); ++i) {
    const MotionBlock& block = field_.blocks()[i];
    if (!objects_.is_measured(i) && !block.has_corners()) continue;
    const Eigen::Vector2f to = centre_px + scale * block.centre_px;
    const Eigen::Vector2f from = to - scale * block.moved_px;
    points.push_back({static_cast<uint32_t>(i), {from.x(), from.y()}, {to.x(), to.y()}});
  }
}

bool MotionEstimator::estimate(const ImageView& image, const ReducedFrame& reduced,
                               MeasuredFrame& frame, uint32_t felt) {
  if (reduced.picture() == FrameComparison::kSame && field_.has_picture()) {
    field_.set_still();
  } else if (field_.update(reduced.base()) != BlockField::Result::kMoved) {
    camera_.reset();
    objects_.reset();
    dominant_.reset();
    windows_.reset();
    frame.features = 0;
    return false;
  }
  const double interval_s = frame.interval_s();
  const FieldPosition position = position_of(field_, reduced);
  const std::vector<FineMotion>& fine = windows_.find(image, field_, position);
  const Background& background = camera_.find(field_, objects_.past());
  frame.background = in_pixels_of(background, position.scale);
  frame.votes = static_cast<int>(camera_.votes());
  // The camera's motion depends on the objects, too: blocks that move by themselves or are burned
  // in have a smaller vote, or none.
  const Eigen::Vector2d middle_px((reduced.width() - 1) / 2.0, (reduced.height() - 1) / 2.0);
  const FieldInFrame in_frame{field_, position.scale, position.centre_px - middle_px, interval_s,
                              fine};
  const std::vector<MovingObject>& objects = objects_.update(in_frame, background, felt);
  camera_.learn_noise([this](size_t block) { return objects_.moves(block); });
  frame.objects = objects;
  const MovingObject* const dominant = dominant_.choose(objects, interval_s);
  frame.dominant = dominant ? dominant->id : 0;
  report_points(position, frame.points);
  store_windows(image, position);
  frame.features = static_cast<int>(frame.points.size());
  return true;
}

void MotionEstimator::reset() {
  windows_.reset();
  field_.reset();
  camera_.reset();
  objects_.reset();
  dominant_.reset();
}

}  // namespace spidar
