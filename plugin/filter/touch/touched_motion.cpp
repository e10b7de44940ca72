// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/touch/touched_motion.h"

namespace spidar {
namespace {

const MovingObject* object_at(const std::vector<MovingObject>& objects,
                              const Eigen::Vector2d& at_px) {
  const MovingObject* found = nullptr;
  for (const MovingObject& object : objects) {
    const Eigen::Array2d away_px = (at_px - object.position_px).array().abs();
    const bool inside = (away_px <= 0.5 * object.size_px.array()).all();
    if (!inside || object.tracks == 0) continue;
    if (found == nullptr || object.area_px2 < found->area_px2) found = &object;
  }
  return found;
}

}  // namespace

Eigen::Vector2d touched_displacement_px(const Frame& frame, const Eigen::Vector2d& place) {
  if (frame.picture == PictureKind::kFirst || is_again(frame.picture) || frame.interval_ns <= 0) {
    return Eigen::Vector2d::Zero();
  }
  const double passed_s = 1e-9 * static_cast<double>(frame.interval_ns);
  const Eigen::Vector2d at_px((place.x() - 0.5) * frame.width, (place.y() - 0.5) * frame.height);
  const MovingObject* const object = object_at(frame.objects, at_px);
  if (object != nullptr) return passed_s * object->on_screen_px_s;
  if (frame.background) return frame.background->model.displacement_px(at_px);
  return passed_s * frame.motion.velocity_px_s;
}

}  // namespace spidar
