// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/support/known_motion.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace spidar::test {
namespace {

/// The displacement between two frames of the position `at_px` in the first one.
Eigen::Vector2d moved_px(const SheetPath& pose, int frame, const Eigen::Vector2d& at_px) {
  return pose(frame) * (pose(frame - 1).inverse() * at_px) - at_px;
}

/// Pixels from a position on the object to its edge, positive inside; exact for a circle and on the
/// edge.
double inside_px(const FilmObject& object, const Eigen::Vector2d& on_object) {
  const Eigen::Vector2d unit = on_object.cwiseQuotient(object.radii_px);
  const double r = unit.norm();
  if (r == 0) return object.radii_px.minCoeff();
  const double slope = unit.cwiseQuotient(object.radii_px).norm() / r;
  return (1 - r) / slope;
}

}  // namespace

Eigen::Vector2d Film::object_displacement_px(int frame, const FilmObject& object,
                                             const Eigen::Vector2d& from_px) const {
  const Eigen::Vector2d at_px = from_px - middle_px();
  return moved_px(object.pose, frame, at_px) - moved_px(background_at(frame).pose, frame, at_px);
}

void Film::add_object(double time, const FilmObject& object) {
  const Eigen::Affine2d to_object = object.pose(time).inverse();
  const Eigen::Affine2d pose = object.pose(time);
  // The box around the ellipse, and a pixel for its soft edge.
  const Eigen::Vector2d reach =
      (pose.linear() * object.radii_px.asDiagonal()).rowwise().norm().array() + 2;
  const Eigen::Vector2d centre = pose.translation() + middle_px();
  const int left = std::max(0, static_cast<int>(std::floor(centre.x() - reach.x())));
  const int right = std::min(width() - 1, static_cast<int>(std::ceil(centre.x() + reach.x())));
  const int top = std::max(0, static_cast<int>(std::floor(centre.y() - reach.y())));
  const int bottom = std::min(height() - 1, static_cast<int>(std::ceil(centre.y() + reach.y())));
  if (left > right) return;
  const double scale = std::sqrt(std::abs(pose.linear().determinant()));
  const Eigen::Vector2d step = to_object.linear().col(0);
  std::vector<float> row(static_cast<size_t>(right - left + 1));
  for (int y = top; y <= bottom; ++y) {
    const Eigen::Vector2d start = to_object * (Eigen::Vector2d(left, y) - middle_px());
    object.sheet->line(start, step, right - left + 1, row.data());
    float* out = sharp_.data() + static_cast<size_t>(y) * static_cast<size_t>(width());
    for (int x = left; x <= right; ++x) {
      const Eigen::Vector2d on_object = start + (x - left) * step;
      // The fraction of the pixel that the object covers, with its edge taken as straight.
      const auto cover =
          static_cast<float>(std::clamp(inside_px(object, on_object) * scale + 0.5, 0.0, 1.0));
      out[x] += cover * (row[static_cast<size_t>(x - left)] - out[x]);
    }
  }
}

void Film::add_exposure(double time, const FilmBackground& behind, float weight) {
  const Eigen::Affine2d to_sheet = behind.pose(time).inverse();
  for (int y = 0; y < height(); ++y) {
    behind.sheet->line(to_sheet * (Eigen::Vector2d(0, y) - middle_px()), to_sheet.linear().col(0),
                       width(),
                       sharp_.data() + static_cast<size_t>(y) * static_cast<size_t>(width()));
  }
  for (const FilmObject& object : objects) add_object(time, object);
  for (size_t k = 0; k < sharp_.size(); ++k) exposed_[k] += weight * sharp_[k];
}

/// Applies a Gaussian, with the picture's edge repeated.
void Film::blur() {
  const int reach = static_cast<int>(std::ceil(3 * blur_px));
  std::vector<float> kernel;
  float sum = 0;
  for (int k = -reach; k <= reach; ++k) {
    kernel.push_back(static_cast<float>(std::exp(-k * k / (2 * blur_px * blur_px))));
    sum += kernel.back();
  }
  for (float& k : kernel) k /= sum;
  const auto at = [this](std::vector<float>& image, int x, int y) -> float& {
    return image[static_cast<size_t>(y) * static_cast<size_t>(width()) + static_cast<size_t>(x)];
  };
  std::fill(sharp_.begin(), sharp_.end(), 0.0f);
  for (int y = 0; y < height(); ++y) {
    for (int k = -reach; k <= reach; ++k) {
      const float weight = kernel[static_cast<size_t>(k + reach)];
      float* out = &at(sharp_, 0, y);
      const float* in = &at(exposed_, 0, std::clamp(y + k, 0, height() - 1));
      for (int x = 0; x < width(); ++x) out[x] += weight * in[x];
    }
  }
  for (int y = 0; y < height(); ++y) {
    const float* in = &at(sharp_, 0, y);
    for (int x = 0; x < width(); ++x) {
      float grey = 0;
      for (int k = -reach; k <= reach; ++k) {
        grey += kernel[static_cast<size_t>(k + reach)] * in[std::clamp(x + k, 0, width() - 1)];
      }
      at(exposed_, x, y) = grey;
    }
  }
}

/// Adds light and noise, and rounds grey levels.
void Film::develop(int frame) {
  const Light lit = light ? light(frame) : Light();
  std::mt19937 random(noise_seed + static_cast<uint32_t>(frame));
  std::normal_distribution<double> gaussian(0, std::max(noise, 1e-9));
  const float* grey = exposed_.data();
  picture_.fill([&](double, double) {
    const double level = lit.gain * static_cast<double>(*grey++) + lit.offset;
    return std::clamp(noise > 0 ? level + gaussian(random) : level, 0.0, 255.0);
  });
}

/// The fastest part moves by steps of 2 px, the width of a control value, while the shutter is
/// open.
int Film::exposures_at(int frame) const {
  constexpr double kStep_px = 2;
  if (shutter == 0) return 1;
  const auto path_px = [&](const SheetPath& pose) {
    return (pose(frame + shutter / 2).translation() - pose(frame - shutter / 2).translation())
        .norm();
  };
  double longest_px = path_px(background_at(frame).pose);
  for (const FilmObject& object : objects) longest_px = std::max(longest_px, path_px(object.pose));
  return 1 + static_cast<int>(std::ceil(longest_px / kStep_px));
}

ImageView Film::draw(int frame) {
  const size_t pixels = static_cast<size_t>(width()) * static_cast<size_t>(height());
  sharp_.resize(pixels);
  exposed_.assign(pixels, 0);
  const int exposures = exposures_at(frame);
  for (int k = 0; k < exposures; ++k) {
    const double time = frame + shutter * ((k + 0.5) / exposures - 0.5);
    add_exposure(time, background_at(frame), 1.0f / static_cast<float>(exposures));
  }
  if (blur_px > 0) blur();
  develop(frame);
  return picture_.view();
}

}  // namespace spidar::test
