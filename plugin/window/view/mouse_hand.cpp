// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/view/mouse_hand.h"

#include <algorithm>
#include <cmath>

namespace spidar {
std::optional<Eigen::Vector3d> MouseHand::update(const Mouse& mouse, const Rect& picture,
                                                 const TouchMap& map) {
  over_ = picture.has(mouse.at_px) && !mouse.taken;
  const bool begins = mouse.down && !was_down_ && over_;
  was_down_ = mouse.down;
  holds_ = mouse.down && (holds_ || begins);
  double deeper_m = over_ || holds_ ? kNotch_m * mouse.wheel : 0;
  // The position is not finite if the window system has lost the mouse; the hand then stays.
  if (holds_ && mouse.at_px.allFinite()) {
    if (begins || !mouse.shift) {
      place_ = {(mouse.at_px.x() - picture.x) / picture.width,
                (mouse.at_px.y() - picture.y) / picture.height};
    } else {
      // The same mouse travel moves the hand as far in depth as it would in the picture.
      const double up = (last_px_.y() - mouse.at_px.y()) / picture.height;
      deeper_m += up * 2 * map.pointer.half_size_m().y();
    }
    last_px_ = mouse.at_px;
  }
  z_m_ = std::clamp(z_m_ - deeper_m, -kFurthest_m, kFurthest_m);
  if (!holds_) return std::nullopt;
  const Eigen::Vector2d at_m = map.position_m(place_);
  return Eigen::Vector3d(at_m.x(), at_m.y(), z_m_);
}

}  // namespace spidar
