// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Interface of a type of device that takes a force itself, without strings.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "spidar/boards/board.h"
#include "spidar/grip/grip_abilities.h"
#include "spidar/grip/pose_trouble.h"

namespace spidar {

struct ForceOutput {
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();  ///< on the hand, device frame
  bool on = false;  ///< forces are switched on, also where there is none at present
};

inline bool pulls(const ForceOutput& output) noexcept {
  return output.on || !output.force_N.isZero(0);
}

inline ForceOutput scaled(ForceOutput output, double share) noexcept {
  output.force_N *= share;
  return output;
}

struct ForceReading {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< of the grip, device frame
  PoseTrouble trouble =
      PoseTrouble::kNoReading;  ///< why the position is not a number, if it is not
  uint32_t buttons = 0;         ///< those that are pressed; the first one is the lowest bit
};

/// Shortens a force that it cannot give, and gives none for one that is not a number.
class ForceBoard : public BoardOf<ForceOutput, ForceReading> {
 public:
  /// See Grip::abilities(). Any thread.
  virtual GripAbilities abilities() const noexcept = 0;
};

}  // namespace spidar
