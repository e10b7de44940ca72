// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The hand of the simulated device, led by the mouse of one window.
#pragma once

#include <memory>
#include <optional>

#include "plugin/window/touch/mouse_hand.h"
#include "plugin/window/window_source.h"

namespace spidar {

/// The mouse as Dear ImGui has it in this frame of the window.
Mouse read_mouse();

/// Tells the source where the hand goes, and that it lets go when the window closes.
class HandControl {
 public:
  explicit HandControl(std::shared_ptr<WindowSource> source) : source_(std::move(source)) {}
  ~HandControl() { lead(std::nullopt); }
  HandControl(const HandControl&) = delete;
  HandControl& operator=(const HandControl&) = delete;

  /// Once a frame. `picture`: the part of the window that shows the visible part of the frame.
  void update(const Mouse& mouse, const Rect& picture, const TouchMap& map) {
    lead(hand_.update(mouse, picture, map));
  }
  /// Instead, when there is nothing that a mouse could move.
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
