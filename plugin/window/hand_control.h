// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Controls the hand of the simulated device with the mouse of one window.
#pragma once

#include <memory>
#include <optional>

#include "plugin/window/model/mouse_hand.h"
#include "plugin/window/model/window_source.h"

namespace spidar {

/// Reads the mouse state of the current window frame from Dear ImGui.
Mouse read_mouse();

/// Passes the target of the hand to the source, and releases the hand when the window closes.
class HandControl {
 public:
  explicit HandControl(std::shared_ptr<WindowSource> source) : source_(std::move(source)) {}
  ~HandControl() { lead(std::nullopt); }
  HandControl(const HandControl&) = delete;
  HandControl& operator=(const HandControl&) = delete;

  /// Call once per frame. `picture` is the part of the window that shows the visible part of the
  /// frame.
  void update(const Mouse& mouse, const Rect& picture, const TouchMap& map) {
    lead(hand_.update(mouse, picture, map));
  }
  /// Call instead of update() when there is no hand to control.
  void let_go() {
    hand_.let_go();
    lead(std::nullopt);
  }
  const MouseHand& hand() const { return hand_; }

 private:
  void lead(const std::optional<Eigen::Vector3d>& to_m) {
    if (to_m == led_to_m_) return;
    led_to_m_ = to_m;
    source_->lead_hand(to_m);
  }

  std::shared_ptr<WindowSource> source_;
  MouseHand hand_;
  std::optional<Eigen::Vector3d> led_to_m_;
};

}  // namespace spidar
