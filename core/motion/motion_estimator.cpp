#include "core/motion/motion_estimator.h"

namespace spidar {
namespace {

/// The camera does the inverse of what the picture does.
ImageMotion camera_motion(const MotionModel& background, int tracked, double interval_s) {
  ImageMotion camera;
  camera.velocity_px_s = -background.shift_px / interval_s;
  camera.growth_1_s = -background.growth() / (1 + background.growth()) / interval_s;
  camera.roll_rad_s = -background.roll_rad() / interval_s;
  camera.tracked = tracked;
  return camera;
}

ImageMotion motion_of(const MovingObject& object) {
  ImageMotion motion;
  motion.velocity_px_s = object.relative_px_s;
  motion.growth_1_s = object.growth_1_s;
  motion.roll_rad_s = object.roll_rad_s;
  motion.tracked = object.tracks;
  return motion;
}

/// Mean over the area that the objects cover; those at rest count, those out of sight do not.
ImageMotion weighted_by_area(const std::vector<MovingObject>& objects) {
  ImageMotion sum;
  double area_px2 = 0;
  for (const MovingObject& object : objects) {
    if (object.tracks == 0) continue;
    const double weight = object.area_px2();
    area_px2 += weight;
    sum.velocity_px_s += weight * object.relative_px_s;
    sum.growth_1_s += weight * object.growth_1_s;
    sum.roll_rad_s += weight * object.roll_rad_s;
    sum.tracked += object.tracks;
  }
  if (area_px2 == 0) return sum;
  sum.velocity_px_s /= area_px2;
  sum.growth_1_s /= area_px2;
  sum.roll_rad_s /= area_px2;
  return sum;
}

}  // namespace

SceneMotion MotionEstimator::estimate(MotionKind kind, const std::vector<Track>& tracks, int width,
                                      int height, int64_t interval_ns) {
  SceneMotion scene;
  if (kind == MotionKind::kMean) {
    scene.felt = mean_motion(tracks, interval_ns);
    return scene;
  }
  const double interval_s = static_cast<double>(interval_ns) * 1e-9;
  displacements(tracks, width, height, points_);
  const Background& background = background_.estimate(points_, width, height);
  scene.model = background.model.kind;
  scene.camera = camera_motion(background.model, static_cast<int>(tracks.size()), interval_s);
  const std::vector<MovingObject>& objects =
      objects_.update(points_, background, width, height, interval_s);
  scene.objects = static_cast<int>(objects.size());
  scene.background = &background;
  scene.objects_seen = &objects;
  const MovingObject* dominant = dominant_.choose(objects, interval_s);
  if (kind == MotionKind::kCamera) {
    scene.felt = scene.camera;
  } else if (kind == MotionKind::kObjects) {
    scene.felt = weighted_by_area(objects);
  } else if (dominant) {
    scene.felt = motion_of(*dominant);
  }
  return scene;
}

void MotionEstimator::reset() {
  background_.reset();
  objects_.reset();
  dominant_.reset();
}

}  // namespace spidar
