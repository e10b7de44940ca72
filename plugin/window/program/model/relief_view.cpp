// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/program/model/relief_view.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace spidar {
namespace {

/// Unit vector towards the light.
const Eigen::Vector3d kLight = Eigen::Vector3d(-1, 1, 1.6).normalized();
constexpr double kAmbient = 0.15;

uint8_t level(double share) {
  return static_cast<uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
}

}  // namespace

std::vector<uint8_t> shade_relief(const HeightField& relief) {
  std::vector<uint8_t> rgba(4 * static_cast<size_t>(HeightField::kCells));
  uint8_t* pixel = rgba.data();
  for (int y = 0; y < HeightField::kRows; ++y) {
    // Central differences, one-sided at the border.
    const int above = std::max(y - 1, 0), below = std::min(y + 1, HeightField::kRows - 1);
    const double down_m = (below - above) * relief.cell_y_m();
    for (int x = 0; x < HeightField::kColumns; ++x) {
      const int left = std::max(x - 1, 0), right = std::min(x + 1, HeightField::kColumns - 1);
      const double across_m = (right - left) * relief.cell_x_m();
      SurfacePoint point;
      point.slope = {(relief.row(y)[right] - relief.row(y)[left]) / across_m,
                     (relief.row(above)[x] - relief.row(below)[x]) / down_m};
      const double lit = std::max(0.0, point.normal().dot(kLight));
      const uint8_t grey = level(kAmbient + (1 - kAmbient) * lit);
      *pixel++ = grey;
      *pixel++ = grey;
      *pixel++ = grey;
      *pixel++ = 255;
    }
  }
  return rgba;
}

std::vector<Eigen::Vector2d> relief_section(const HeightField& relief, double y_m, int points) {
  std::vector<Eigen::Vector2d> section;
  section.reserve(static_cast<size_t>(std::max(points, 0)));
  for (int i = 0; i < points; ++i) {
    const double share = points > 1 ? static_cast<double>(i) / (points - 1) : 0.5;
    const double x_m = (share - 0.5) * relief.width_m();
    section.emplace_back(x_m, relief.at(x_m, y_m).z_m);
  }
  return section;
}

std::vector<Eigen::Vector2d> touched_section(const HeightField& relief, const TickRecord& tick,
                                             int points) {
  const bool touching = tick.contact.touching;
  const Eigen::Vector3d& at_m = touching ? tick.contact.proxy_m : tick.pose.position_m;
  const double higher_m = touching ? at_m.z() - relief.at(at_m.x(), at_m.y()).z_m : 0;
  std::vector<Eigen::Vector2d> section = relief_section(relief, at_m.y(), points);
  for (Eigen::Vector2d& point_m : section) point_m.y() += higher_m;
  return section;
}

std::string depth_line(const TouchScene& scene, const TickRecord& tick) {
  char text[64];
  if (tick.contact.touching) {
    std::snprintf(text, sizeof text, "%.1f mm deep", 1e3 * tick.contact.depth_m);
    return text;
  }
  if (!scene.relief) return {};
  const Eigen::Vector3d& grip_m = tick.pose.position_m;
  const double front_m = grip_m.z() - scene.relief->at(grip_m.x(), grip_m.y()).z_m;
  // Relative to the newest frame, which may not be on the screen yet.
  std::snprintf(text, sizeof text, "%.1f mm in front", 1e3 * std::max(front_m, 0.0));
  return text;
}

}  // namespace spidar
