// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/simulation/led_hand.h"

namespace spidar {

const Pose& LedHand::follow(const Pose& rest, const HandLead& lead, double dt_s) noexcept {
  if (!away_) pose_ = rest;
  if (!away_ && !lead.leads) return pose_;
  const Eigen::Vector3d way_m = (lead.leads ? lead.to_m : rest.position_m) - pose_.position_m;
  const double most_m = kFastest_m_s * dt_s;
  const double length_m = way_m.norm();
  away_ = lead.leads || length_m > most_m;
  pose_.orientation = rest.orientation;
  if (length_m > most_m) {
    pose_.position_m += most_m / length_m * way_m;
  } else {
    pose_.position_m += way_m;
  }
  return pose_;
}

}  // namespace spidar
