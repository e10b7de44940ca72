// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The mouse over the picture as the hand of a simulated device.
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "plugin/overlay/touch_view.h"
#include "plugin/window/layout.h"

namespace spidar {

/// The mouse in one frame of the window.
struct Mouse {
  Eigen::Vector2d at_px = Eigen::Vector2d::Zero();  ///< in the window
  bool down = false;                                ///< its left button
  bool shift = false;                               ///< the key
  double wheel = 0;    ///< notches since the frame before, > 0 away from the user
  bool taken = false;  ///< it is over a widget
};

/// Pressed in the picture it holds the grip there; the wheel, or moving up and down with Shift,
/// moves the hand deeper into the picture (away from the viewer, z < 0) or nearer. The depth stays
/// when the button is released.
class MouseHand {
 public:
  MouseHand() = default;

  static constexpr double kNotch_m = 0.5e-3;    ///< of the wheel
  static constexpr double kFurthest_m = 25e-3;  ///< from the middle, either way

  /// Where the hand goes, device frame; nothing while it lets go. `picture` is the part of the
  /// window that shows the visible part of the frame.
  std::optional<Eigen::Vector3d> update(const Mouse& mouse, const Rect& picture,
                                        const TouchMap& map);
  void let_go() { *this = MouseHand(z_m_); }

  bool holds() const { return holds_; }
  /// The mouse is in the picture.
  bool is_over() const { return over_; }
  double z_m() const { return z_m_; }

 private:
  explicit MouseHand(double z_m) : z_m_(z_m) {}

  bool was_down_ = false;
  bool holds_ = false;
  bool over_ = false;
  double z_m_ = 0;
  Eigen::Vector2d last_px_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d place_ = Eigen::Vector2d::Zero();
};

/// The line that explains it: what can be done, or while it holds, where the hand is.
std::string hand_line(const MouseHand& hand);

}  // namespace spidar
