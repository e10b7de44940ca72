#include "core/motion/motion_estimator.h"

#include <cmath>

namespace spidar {
namespace {

/// The camera does the inverse of what the picture does.
ImageMotion camera_motion(const Background& background, int tracked, double interval_s) {
  const MotionModel& model = background.model;
  ImageMotion camera;
  camera.velocity_px_s = -model.shift_px / interval_s;
  camera.growth_1_s = -model.growth() / (1 + model.growth()) / interval_s;
  camera.roll_rad_s = -model.roll_rad() / interval_s;
  camera.tracked = tracked;
  if (tracked > 0) camera.noise_px_s = background.sigma_px / std::sqrt(tracked) / interval_s;
  return camera;
}

ImageMotion motion_of(const MovingObject& object) {
  ImageMotion motion;
  motion.velocity_px_s = object.relative_px_s;
  motion.growth_1_s = object.growth_1_s;
  motion.roll_rad_s = object.roll_rad_s;
  motion.tracked = object.tracks;
  motion.noise_px_s = object.noise_px_s;
  return motion;
}

double weight_at(const Eigen::Vector2d& pointer_px, const MovingObject& object, int frame_height) {
  const Eigen::Vector2d outside_px =
      ((pointer_px - object.position_px).cwiseAbs() - object.size_px / 2).cwiseMax(0.0);
  const double sigma_px = kPointerReach * frame_height;
  return object.area_px2() * std::exp(-outside_px.squaredNorm() / (2 * sigma_px * sigma_px));
}

}  // namespace

ImageMotion motion_at_pointer(const std::vector<MovingObject>& objects,
                              const Eigen::Vector2d& pointer_px, int frame_height) {
  ImageMotion sum;
  double weights = 0;
  double variance = 0;
  for (const MovingObject& object : objects) {
    if (object.tracks == 0) continue;
    const double weight = weight_at(pointer_px, object, frame_height);
    weights += weight;
    sum.velocity_px_s += weight * object.relative_px_s;
    sum.growth_1_s += weight * object.growth_1_s;
    sum.roll_rad_s += weight * object.roll_rad_s;
    sum.tracked += object.tracks;
    variance += weight * weight * object.noise_px_s * object.noise_px_s;
  }
  if (weights == 0) return sum;
  sum.velocity_px_s /= weights;
  sum.growth_1_s /= weights;
  sum.roll_rad_s /= weights;
  sum.noise_px_s = std::sqrt(variance) / weights;
  return sum;
}

SceneMotion MotionEstimator::estimate(MotionKind kind, const std::vector<Track>& tracks, int width,
                                      int height, int64_t interval_ns,
                                      const Eigen::Vector2d& pointer) {
  if (kind != kind_) drop_unneeded(kind);
  SceneMotion scene;
  if (kind == MotionKind::kMean) {
    scene.felt = mean_motion(tracks, interval_ns);
    return scene;
  }
  const double interval_s = static_cast<double>(interval_ns) * 1e-9;
  displacements(tracks, width, height, points_);
  const Background& background = background_.estimate(points_, width, height);
  scene.background = &background;
  scene.model = background.model.kind;
  scene.camera = camera_motion(background, static_cast<int>(points_.size()), interval_s);
  if (kind == MotionKind::kCamera) {
    scene.felt = scene.camera;
    return scene;
  }
  const std::vector<MovingObject>& objects =
      objects_.update(points_, background, width, height, interval_s);
  scene.objects = static_cast<int>(objects.size());
  scene.object_list = &objects;
  // Also while all of them are felt: who then asks for one gets the one that was looked at.
  scene.dominant = dominant_.choose(objects, interval_s);
  if (kind == MotionKind::kObjects) {
    const Eigen::Vector2d pointer_px((pointer.x() - 0.5) * width, (pointer.y() - 0.5) * height);
    scene.felt = motion_at_pointer(objects, pointer_px, height);
  } else if (scene.dominant) {
    scene.felt = motion_of(*scene.dominant);
  }
  return scene;
}

/// What a kind does not keep up to date would be stale when it is needed again.
void MotionEstimator::drop_unneeded(MotionKind kind) {
  kind_ = kind;
  if (kind == MotionKind::kMean) background_.reset();
  if (kind == MotionKind::kMean || kind == MotionKind::kCamera) {
    objects_.reset();
    dominant_.reset();
  }
}

void MotionEstimator::reset() {
  background_.reset();
  objects_.reset();
  dominant_.reset();
}

}  // namespace spidar
