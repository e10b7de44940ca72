// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Where the grip touches the picture, as data: for the overlay and the window.
#pragma once

#include <memory>
#include <optional>

#include <Eigen/Core>

#include "core/touch/height_field.h"
#include "plugin/engine/grip_pointer.h"
#include "spidar/loop/tick_record.h"

namespace spidar {

/// The picture in the hand's space.
struct TouchMap {
  GripPointer pointer;

  /// Place in the picture, which is the part of the frame that is analysed: (0, 0) is its top left
  /// corner and (1, 1) its bottom right one. Positions beyond the picture are at its edge.
  Eigen::Vector2d place(const Eigen::Vector3d& position_m) const;
  /// The reverse: x and y in the device frame.
  Eigen::Vector2d position_m(const Eigen::Vector2d& place) const;
};

/// What is there to be touched, of one frame.
struct TouchScene {
  bool on = false;  ///< touch is not off and a device is open; else nothing below is known
  TouchMap map;
  double stiffness_N_m = 0;                   ///< that is rendered
  double motion_share = 0;                    ///< of the film's motion, which is felt besides
  std::shared_ptr<const HeightField> relief;  ///< null unless a window has asked for it
};

/// Finger and proxy in one tick, as places in the picture.
struct TouchMark {
  Eigen::Vector2d finger = Eigen::Vector2d::Zero();
  bool touching = false;
  Eigen::Vector2d proxy = Eigen::Vector2d::Zero();    ///< while touching
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();  ///< of the contact, on the grip
};

/// Nothing when touch is off, or the device does not run.
std::optional<TouchMark> touch_mark(const TouchScene& scene, const TickRecord& tick);

/// Radii of the marks: a ring for the finger, and a disc for the proxy that grows with the force
/// towards the viewer, in pixels of what is `height_px` high.
double finger_radius_px(double height_px);
double proxy_radius_px(const TouchMark& mark, double max_force_N, double height_px);

}  // namespace spidar
