// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "core/grip/string_geometry.h"
#include "core/orientation.h"
#include "spidar/loop/tick_record.h"

namespace spidar {

/// Maps the position of the grip to one in the picture, which stands upright in the xy plane of the
/// device. The middle of the picture is the centre of the workspace. Its edges are halfway from
/// there to the box around the exits of the strings, where a hand can still hold the grip
/// (docs/strings.md). Depth and rotation of the grip do not move the pointer. `turn` is how the
/// picture is turned for display; positions are those before that: (0, 0) is top left, (1, 1)
/// bottom right.
class GripPointer {
 public:
  /// Without a device, every position is the middle.
  GripPointer() = default;
  explicit GripPointer(const StringGeometry& geometry, const Orientation& turn = {});
  GripPointer(const Eigen::Vector2d& half_size_m, const Orientation& turn)
      : half_size_m_(half_size_m), turn_(turn) {}

  /// A grip outside the picture points at the edge.
  Eigen::Vector2d position(const Eigen::Vector3d& position_m) const;
  /// The inverse of position(): x and y in the device frame.
  Eigen::Vector2d position_m(const Eigen::Vector2d& position) const;

  /// Half the size, in x and y, of the box that maps to the picture.
  const Eigen::Vector2d& half_size_m() const { return half_size_m_; }
  const Orientation& turn() const { return turn_; }

 private:
  Eigen::Vector2d half_size_m_ = Eigen::Vector2d::Zero();
  Orientation turn_;
};

/// The touchable surface of one frame.
struct TouchScene {
  bool on = false;  ///< touch is on and a device is open; otherwise the rest is not valid
  GripPointer pointer;
  double stiffness_N_m = 0;    ///< the rendered stiffness
  double motion_fraction = 0;  ///< the fraction of the film's motion that is also rendered
  /// touch::HeightField::shading() of the shown picture; empty: not shown.
  std::string shading = {};
};

/// Finger and proxy in one tick, as positions in the picture.
struct TouchMark {
  Eigen::Vector2d finger = Eigen::Vector2d::Zero();
  bool touching = false;
  Eigen::Vector2d proxy = Eigen::Vector2d::Zero();    ///< only while touching
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();  ///< on the grip
};

/// Returns nothing when touch is off or the device is not running.
std::optional<TouchMark> touch_mark(const TouchScene& scene, const TickRecord& tick);

/// Radii of the marks in a picture that is `height_px` high: a ring for the finger, and a disc for
/// the proxy that grows with the force towards the viewer.
double finger_radius_px(double height_px);
double proxy_radius_px(const TouchMark& mark, double max_force_N, double height_px);

}  // namespace spidar
