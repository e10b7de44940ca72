// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Statistics of the force that a device delivers over many poses.
#pragma once

#include <string>
#include <vector>

#include "spidar/profiles/profile.h"

/// Poses of the grip: uniformly within ± `reach_m` of the centre in x, y and z, rotated by up to
/// `angle_rad` about any axis, all amounts being equally likely.
struct Region {
  std::string name;
  Eigen::Vector3d reach_m = Eigen::Vector3d::Zero();
  double angle_rad = 0;
};

/// Regions of the same size for every device, followed by the box that contains its exits.
std::vector<Region> regions(const spidar::Profile& profile);

/// Half the size of the box that contains all exits, metres.
Eigen::Vector3d frame_half_size_m(const spidar::Profile& profile);

/// Over all poses and directions.
struct DeliverySummary {
  double force_median_N = 0, force_5_N = 0;       ///< 5 %: 5th percentile
  double moment_median_Nm = 0, moment_95_Nm = 0;  ///< 95 %: 95th percentile
};

struct Survey {
  double closed = 0;    ///< share of poses with force closure
  double balanced = 0;  ///< share of poses with force closure and W t = 0 within bounds
  double feasible = 0;  ///< share of poses where the wanted force is possible in every direction
  DeliverySummary loop, published;
};

/// Random poses from a fixed seed. Throws std::runtime_error.
Survey survey(const spidar::Profile& profile, const Region& region);

/// Prints the Markdown table of all `profiles` on standard output.
void print_surveys(const std::vector<spidar::Profile>& profiles);
