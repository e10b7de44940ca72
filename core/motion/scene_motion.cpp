// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/scene_motion.h"

#include <cmath>

namespace spidar {
namespace {

double weight_at(const Eigen::Vector2d& pointer_px, const MovingObject& object, int frame_height) {
  const double sigma_px = kPointerReach * frame_height;
  return object.area_px2 *
         std::exp(-object.box_px().squaredExteriorDistance(pointer_px) / (2 * sigma_px * sigma_px));
}

double area_in_box(const MovingObject& object, const Eigen::AlignedBox2d& box_px) {
  const double all_px2 = object.size_px.prod();
  if (!(all_px2 > 0)) return 0;
  return object.area_px2 * area_px2(object.box_px().intersection(box_px)) / all_px2;
}

/// The mean motion of the objects in sight, each with its weight.
template <typename Weight>
ImageMotion weighted_motion(const std::vector<MovingObject>& objects, Weight&& weight_of) {
  ImageMotion sum;
  double weights = 0;
  double variance = 0;
  for (const MovingObject& object : objects) {
    if (object.tracks == 0) continue;
    const double weight = weight_of(object);
    weights += weight;
    sum.velocity_px_s += weight * object.relative_px_s;
    sum.growth_1_s += weight * object.growth_1_s;
    sum.roll_rad_s += weight * object.roll_rad_s;
    sum.tracked += object.tracks;
    const double noise_px_s = kNoiseOfError * object.error_px_s;
    variance += weight * weight * noise_px_s * noise_px_s;
  }
  if (weights == 0) return sum;
  sum.velocity_px_s /= weights;
  sum.growth_1_s /= weights;
  sum.roll_rad_s /= weights;
  sum.noise_px_s = std::sqrt(variance) / weights;
  return sum;
}

}  // namespace

ImageMotion camera_motion(const Background& background, int votes, double interval_s) {
  const MotionModel& model = background.model;
  ImageMotion camera;
  camera.velocity_px_s = -model.shift_px / interval_s;
  camera.growth_1_s = -model.growth() / (1 + model.growth()) / interval_s;
  camera.roll_rad_s = -model.roll_rad() / interval_s;
  camera.tracked = votes;
  if (votes > 0) camera.noise_px_s = background.sigma_px / std::sqrt(votes) / interval_s;
  return camera;
}

ImageMotion motion_of(const MovingObject& object) {
  ImageMotion motion;
  motion.velocity_px_s = object.relative_px_s;
  motion.growth_1_s = object.growth_1_s;
  motion.roll_rad_s = object.roll_rad_s;
  motion.tracked = object.tracks;
  motion.noise_px_s = kNoiseOfError * object.error_px_s;
  return motion;
}

ImageMotion motion_at_pointer(const std::vector<MovingObject>& objects,
                              const Eigen::Vector2d& pointer_px, int frame_height) {
  return weighted_motion(objects, [&](const MovingObject& object) {
    return weight_at(pointer_px, object, frame_height);
  });
}

ImageMotion motion_in_box(const std::vector<MovingObject>& objects,
                          const Eigen::AlignedBox2d& box_px) {
  return weighted_motion(objects,
                         [&](const MovingObject& object) { return area_in_box(object, box_px); });
}

}  // namespace spidar
