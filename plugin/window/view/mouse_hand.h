// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Core>

#include "plugin/frame/touch_view.h"
#include "plugin/window/view/rect.h"

namespace spidar::window {

/// Mouse state in one frame of the window.
struct Mouse {
  Eigen::Vector2d at_px = Eigen::Vector2d::Zero();  ///< in the window
  bool down = false;                                ///< left button
  bool shift = false;                               ///< Shift key
  double wheel = 0;    ///< notches since the last frame, positive away from the user
  bool taken = false;  ///< whether a widget uses the mouse
};

/// Converts the mouse over the picture to the hand of a simulated device. Pressing the left button
/// in the picture moves the grip there and holds it. The wheel, or dragging up and down with Shift,
/// moves the hand deeper into the picture (away from the viewer, z < 0) or nearer. The depth stays
/// when the button is released.
class MouseHand {
 public:
  MouseHand() = default;

  static constexpr double kNotch_m = 0.5e-3;    ///< depth per notch of the wheel
  static constexpr double kFurthest_m = 25e-3;  ///< largest depth in either direction

  /// Returns the target of the hand in the device frame, or nothing while the hand is released.
  /// `picture` is the part of the window that shows the visible part of the frame.
  std::optional<Eigen::Vector3d> update(const Mouse& mouse, const Rect& picture,
                                        const GripPointer& pointer) {
    over_ = picture.has(mouse.at_px) && !mouse.taken;
    const bool begins = mouse.down && !was_down_ && over_;
    was_down_ = mouse.down;
    holds_ = mouse.down && (holds_ || begins);
    double deeper_m = over_ || holds_ ? kNotch_m * mouse.wheel : 0;
    // The position is not finite if the window system has lost the mouse; the hand then stays.
    if (holds_ && mouse.at_px.allFinite()) {
      if (begins || !mouse.shift) {
        position_ = {(mouse.at_px.x() - picture.x) / picture.width,
                     (mouse.at_px.y() - picture.y) / picture.height};
      } else {
        // The same mouse travel moves the hand as far in depth as it would in the picture.
        const double up = (last_px_.y() - mouse.at_px.y()) / picture.height;
        deeper_m += up * 2 * pointer.half_size_m().y();
      }
      last_px_ = mouse.at_px;
    }
    z_m_ = std::clamp(z_m_ - deeper_m, -kFurthest_m, kFurthest_m);
    if (!holds_) return std::nullopt;
    const Eigen::Vector2d at_m = pointer.position_m(position_);
    return Eigen::Vector3d(at_m.x(), at_m.y(), z_m_);
  }
  void release() { *this = MouseHand(z_m_); }

  bool holds() const { return holds_; }
  bool is_over() const { return over_; }
  double z_m() const { return z_m_; }

 private:
  explicit MouseHand(double z_m) : z_m_(z_m) {}

  bool was_down_ = false;
  bool holds_ = false;
  bool over_ = false;
  double z_m_ = 0;
  Eigen::Vector2d last_px_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d position_ = Eigen::Vector2d::Zero();
};

}  // namespace spidar::window
