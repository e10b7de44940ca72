// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/image_motion.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

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

/// The mean motion of the visible objects, each with its weight.
template <typename Weight>
ImageMotion weighted_motion(const std::vector<MovingObject>& objects, Weight&& weight_of) {
  ImageMotion sum;
  double weights = 0;
  double squares = 0;  // errors of different objects are independent
  for (const MovingObject& object : objects) {
    if (object.points == 0) continue;
    const double weight = weight_of(object);
    weights += weight;
    sum.velocity_px_s += weight * object.relative_px_s;
    sum.growth_1_s += weight * object.growth_1_s;
    sum.roll_rad_s += weight * object.roll_rad_s;
    sum.tracked += object.points;
    squares += std::pow(weight * DeadZone::kOfBound * object.error_px_s, 2);
  }
  if (weights == 0) return sum;
  sum.velocity_px_s /= weights;
  sum.growth_1_s /= weights;
  sum.roll_rad_s /= weights;
  sum.dead_zone_px_s = std::sqrt(squares) / weights;
  return sum;
}

double bounded(double value, double bound) {
  return std::isfinite(value) ? std::clamp(value, -bound, bound) : 0;
}

}  // namespace

ImageMotion mean_motion(const std::vector<FollowedPoint>& points, int64_t interval_ns) {
  if (interval_ns <= 0) {
    throw std::invalid_argument("mean_motion: the interval must be positive, got " +
                                std::to_string(interval_ns) + " ns");
  }
  ImageMotion motion;
  if (points.empty()) return motion;
  Eigen::Vector2d sum_px = Eigen::Vector2d::Zero();
  for (const FollowedPoint& point : points) {
    sum_px.x() += static_cast<double>(point.to.x_px) - static_cast<double>(point.from.x_px);
    sum_px.y() += static_cast<double>(point.to.y_px) - static_cast<double>(point.from.y_px);
  }
  const double interval_s = static_cast<double>(interval_ns) * 1e-9;
  motion.tracked = static_cast<int>(points.size());
  motion.velocity_px_s = sum_px / static_cast<double>(points.size()) / interval_s;
  return motion;
}

ImageMotion camera_motion(const Background& background, int votes, double interval_s) {
  const MotionModel& model = background.model;
  ImageMotion camera;
  camera.velocity_px_s = -model.shift_px / interval_s;
  camera.growth_1_s = -model.growth() / (1 + model.growth()) / interval_s;
  camera.roll_rad_s = -model.roll_rad() / interval_s;
  camera.tracked = votes;
  if (votes > 0) {
    camera.dead_zone_px_s = DeadZone::kSigmas * background.sigma_px / std::sqrt(votes) / interval_s;
  }
  return camera;
}

ImageMotion relative_motion(const MovingObject& object) {
  ImageMotion motion;
  motion.velocity_px_s = object.relative_px_s;
  motion.growth_1_s = object.growth_1_s;
  motion.roll_rad_s = object.roll_rad_s;
  motion.tracked = object.points;
  motion.dead_zone_px_s = DeadZone::kOfBound * object.error_px_s;
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

ImageMotion bound_motion(const ImageMotion& motion, int frame_width, double interval_s) {
  const double frames_1_s = 1 / interval_s;
  ImageMotion possible = motion;
  const double speed_px_s = motion.velocity_px_s.stableNorm();
  const double fastest_px_s = frame_width * frames_1_s;
  if (!std::isfinite(speed_px_s)) {
    possible.velocity_px_s.setZero();
  } else if (speed_px_s > fastest_px_s) {
    possible.velocity_px_s *= fastest_px_s / speed_px_s;
  }
  possible.growth_1_s = bounded(motion.growth_1_s, frames_1_s);
  possible.roll_rad_s = bounded(motion.roll_rad_s, M_PI * frames_1_s);
  return possible;
}

}  // namespace spidar
