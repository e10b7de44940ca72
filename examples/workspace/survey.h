// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a device gives over many poses.
#pragma once

#include <string>
#include <vector>

#include "spidar/profiles/profile.h"

/// Where the grip is: anywhere within ± `reach_m` of the centre in x, y and z, turned by up to
/// `angle_rad` about any axis, each amount as likely as another.
struct Region {
  std::string name;
  Eigen::Vector3d reach_m = Eigen::Vector3d::Zero();
  double angle_rad = 0;
};

/// Regions of the same size for every device, then the box that holds its exits.
std::vector<Region> regions(const spidar::Profile& profile);

/// Half the size of the box that holds all exits, metres.
Eigen::Vector3d frame_half_size_m(const spidar::Profile& profile);

/// Over all poses and directions.
struct DeliverySummary {
  double force_median_N = 0, force_5_N = 0;       ///< 5 %: so much or less
  double moment_median_Nm = 0, moment_95_Nm = 0;  ///< 95 %: so much or less
};

struct Survey {
  double closed = 0;    ///< share of poses with force closure
  double balanced = 0;  ///< share of poses with force closure and W t = 0 within bounds
  double feasible = 0;  ///< share of poses where the wanted force is possible in every direction
  DeliverySummary loop, published;
};

/// Random poses from a fixed seed. Throws std::runtime_error.
Survey survey(const spidar::Profile& profile, const Region& region);

/// The table of all `profiles` as Markdown, on standard output.
void print_surveys(const std::vector<spidar::Profile>& profiles);
