// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "apps/workspace/pose_map.h"

#include <algorithm>
#include <fstream>
#include <functional>
#include <string>

#include "apps/gnuplot.h"
#include "apps/workspace/delivery.h"
#include "apps/workspace/force_closure.h"
#include "apps/workspace/survey.h"

namespace fs = std::filesystem;

namespace {

constexpr int kCells = 61;  // on each side
constexpr int kDirections = 32;
constexpr double kLargestAngle_deg = 90;

/// The worst case over all directions.
Delivery worst_delivery(Deliverer& deliverer, const std::vector<Eigen::Vector3d>& directions) {
  Delivery worst{kWanted_N, 0};
  for (const Eigen::Vector3d& direction : directions) {
    const Delivery delivery = deliverer.deliver(direction);
    worst.force_N = std::min(worst.force_N, delivery.force_N);
    worst.moment_Nm = std::max(worst.moment_Nm, delivery.moment_Nm);
  }
  return worst;
}

/// A plane of poses; coordinates from −`half_size` to `half_size`, in the unit of the axes.
struct Plane {
  Eigen::Vector2d half_size;
  std::function<spidar::Pose(const Eigen::Vector2d&)> pose;
};

spidar::Pose moved(const Eigen::Vector2d& position_mm) {
  spidar::Pose pose;
  pose.position_m << 1e-3 * position_mm, 0;
  return pose;
}

spidar::Pose turned(const Eigen::Vector2d& rotation_deg) {
  spidar::Pose pose;
  const double angle_deg = rotation_deg.norm();
  if (angle_deg > 0)
    pose.orientation = Eigen::AngleAxisd(
        angle_deg * M_PI / 180,
        Eigen::Vector3d(rotation_deg.x() / angle_deg, rotation_deg.y() / angle_deg, 0));
  return pose;
}

void write_plane(const spidar::Profile& profile, const Plane& plane, const fs::path& path) {
  const Weights weights = loop_weights(profile);
  Deliverer deliverers[] = {{profile, weights}, {profile, published_weights()}};
  const std::vector<Eigen::Vector3d> directions = even_directions(kDirections);
  std::ofstream file(path);
  file.exceptions(std::ios::failbit | std::ios::badbit);
  file << "first,second,tension_factor,loop_force_N,loop_moment_Nmm,published_force_N,"
          "published_moment_Nmm\n";
  for (int row = 0; row < kCells; ++row) {
    for (int column = 0; column < kCells; ++column) {
      const Eigen::Vector2d share(2.0 * column / (kCells - 1) - 1, 2.0 * row / (kCells - 1) - 1);
      const Eigen::Vector2d at = plane.half_size.cwiseProduct(share);
      const spidar::StructureMatrix W = structure_matrix(profile.geometry, plane.pose(at));
      file << at.x() << ',' << at.y() << ','
           << force_closure(W, profile.geometry.count, weights.torque_length_m,
                            profile.min_tension_N(), profile.max_tension_N())
                  .tension_factor;
      for (Deliverer& deliverer : deliverers) {
        deliverer.go_to(W);
        const Delivery worst = worst_delivery(deliverer, directions);
        file << ',' << worst.force_N << ',' << 1e3 * worst.moment_Nm;
      }
      file << '\n';
    }
  }
  file.close();
}

}  // namespace

void draw_map(const spidar::Profile& profile, const fs::path& folder) {
  fs::create_directories(folder);
  const std::string name = "workspace-" + profile.name;
  const fs::path position = folder / (name + "-position.csv");
  const fs::path rotation = folder / (name + "-rotation.csv");
  write_plane(profile, {1e3 * frame_half_size_m(profile).head<2>(), moved}, position);
  write_plane(profile, {Eigen::Vector2d::Constant(kLargestAngle_deg), turned}, rotation);
  run_gnuplot("workspace_map.gp",
              {{"position", position}, {"rotation", rotation}, {"png", folder / (name + ".png")}},
              {{"profile", profile.name}});
}
