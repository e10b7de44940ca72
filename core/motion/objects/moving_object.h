// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "core/motion/camera/motion_models.h"

namespace spidar {

/// 95 % of the vectors whose coordinates have Gaussian errors of standard deviation 1 are shorter
/// than this: √(−2 ln 0.05).
constexpr double kErrorSigmas = 2.4477;

/// One object that moves relative to the background, in one frame. Positions are in the image frame
/// I (x right, y down), relative to the centre of the frame.
struct MovingObject {
  uint32_t id = 0;  ///< constant while the object exists, never reused
  Eigen::Vector2d position_px = Eigen::Vector2d::Zero();  ///< of its middle
  Eigen::Vector2d size_px = Eigen::Vector2d::Zero();      ///< of the box around its blocks
  /// Offsets of the upper left and the lower right corner of the drawn box from those of box_px().
  /// That box jumps by whole blocks; the drawn corners move as the object does.
  Eigen::Vector2d low_off_px = Eigen::Vector2d::Zero(), high_off_px = Eigen::Vector2d::Zero();

  Eigen::AlignedBox2d box_px() const {
    return {position_px - size_px / 2, position_px + size_px / 2};
  }
  Eigen::Vector2d drawn_low_px() const { return position_px - size_px / 2 + low_off_px; }
  Eigen::Vector2d drawn_high_px() const { return position_px + size_px / 2 + high_off_px; }
  Eigen::Vector2d relative_px_s = Eigen::Vector2d::Zero();   ///< relative to the background
  Eigen::Vector2d on_screen_px_s = Eigen::Vector2d::Zero();  ///< velocity on the screen
  double growth_1_s = 0;                                     ///< relative to the background,
  double roll_rad_s = 0;                                     ///< as in ImageMotion
  ModelKind model = ModelKind::kTranslation;                 ///< translation or similarity
  int points = 0;  ///< number of measured windows or blocks; 0: invisible
  /// In 95 % of the frames in which the object is visible, relative_px_s differs from the true
  /// velocity by less than this; 0: unknown.
  double error_px_s = 0;
  /// Whether the object was moving out of the picture when it was last seen; it does not come back.
  bool has_left = false;
  double area_px2 = 0;    ///< of its blocks together
  double prominence = 0;  ///< how likely a viewer watches the object, see salience()
};

/// Returns the object with this id, or null.
inline const MovingObject* find_object(const std::vector<MovingObject>& objects, uint32_t id) {
  const auto found = std::find_if(objects.begin(), objects.end(),
                                  [id](const MovingObject& object) { return object.id == id; });
  return found == objects.end() ? nullptr : &*found;
}

/// The area of a box; 0 for an empty one.
inline double area_px2(const Eigen::AlignedBox2d& box_px) {
  return box_px.sizes().cwiseMax(0.0).prod();
}

}  // namespace spidar
