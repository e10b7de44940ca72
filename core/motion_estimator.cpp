#include "core/motion_estimator.h"

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
  scene.felt = scene.camera;
  return scene;
}

void MotionEstimator::reset() {
  background_.reset();
}

}  // namespace spidar
