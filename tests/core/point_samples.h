// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Points of known motion.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "core/motion/camera/motion_models.h"

namespace spidar::test {

/// Seeded; prints nothing: the seed is in the test's message.
class PointSource {
 public:
  explicit PointSource(uint32_t seed, int width = 640, int height = 360)
      : random_(seed), width_(width), height_(height) {}

  int width() const { return width_; }
  int height() const { return height_; }

  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / 4294967296.0;
  }
  double gauss() { return normal_(random_); }
  Eigen::Vector2d noise_px(double sigma_px) {
    const double x = gauss();
    return sigma_px * Eigen::Vector2d(x, gauss());
  }

  /// Anywhere in the frame, from its centre.
  Eigen::Vector2d position_px() {
    const double x = uniform(-0.48, 0.48) * width_;
    return {x, uniform(-0.48, 0.48) * height_};
  }

  Displacement moved(const MotionModel& model, const Eigen::Vector2d& at_px, double sigma_px) {
    return {at_px, model.displacement_px(at_px) + noise_px(sigma_px)};
  }

  std::vector<Displacement> moved(const MotionModel& model, int count, double sigma_px) {
    std::vector<Displacement> points;
    for (int i = 0; i < count; ++i) points.push_back(moved(model, position_px(), sigma_px));
    return points;
  }

  /// Something that has nothing to do with the rest: up to 30 px anywhere.
  Displacement stray() {
    const Eigen::Vector2d at = position_px();
    const double dx = uniform(-30, 30);
    return {at, {dx, uniform(-30, 30)}};
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  int width_;
  int height_;
};

/// A camera that does a little of everything that `kind` can.
inline MotionModel sample_model(ModelKind kind) {
  MotionModel model;
  model.kind = kind;
  if (kind >= ModelKind::kTranslation) model.shift_px << 3.25, -1.5;
  if (kind >= ModelKind::kSimilarity) model.linear << 0.02, -0.015, 0.015, 0.02;
  if (kind >= ModelKind::kAffine) model.linear += Eigen::Matrix2d{{0.012, 0.02}, {-0.006, -0.01}};
  if (kind >= ModelKind::kHomography) model.perspective_1_px << 6e-5, -4e-5;
  return model;
}

}  // namespace spidar::test
