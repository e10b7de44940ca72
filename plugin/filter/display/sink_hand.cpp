// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/display/sink_hand.h"

#include <optional>

namespace spidar {

void SinkHand::see(const FrameReport& report, int width, int height) {
  if (!report.analyzed) return;
  const bool touched = report.touch.on && width > 0 && height > 0;
  if (!touched) return let_go();
  const std::lock_guard<std::mutex> lock(mutex_);
  touched_ = true;
  map_ = report.touch.map;
  const double w = width, h = height;
  const VisiblePart& part = report.visible;
  picture_ = {part.x / w, part.y / h, part.width / w, part.height / h};
}

bool SinkHand::take(const SinkMouse& mouse) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!touched_) return false;
  mouse_.at_px = mouse.place;
  mouse_.shift = mouse.shift;
  mouse_.wheel = mouse.wheel;
  if (mouse.act == SinkMouse::Act::kPress) mouse_.down = true;
  if (mouse.act == SinkMouse::Act::kRelease) mouse_.down = false;
  return output_.lead_hand(hand_.update(mouse_, picture_, map_));
}

void SinkHand::let_go() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!touched_) return;
  touched_ = mouse_.down = false;
  hand_.let_go();
  output_.lead_hand(std::nullopt);
}

}  // namespace spidar
