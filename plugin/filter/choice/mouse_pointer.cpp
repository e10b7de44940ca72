// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/choice/mouse_pointer.h"

namespace spidar {

void MousePointer::take(const SinkMouse& mouse) {
  const bool clicks = mouse.act == SinkMouse::Act::kPress;
  if (!clicks && mouse.act != SinkMouse::Act::kMove) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  place_ = mouse.place;
  if (clicks) kept_ = kept_.click == 0 ? KeptObject{++clicks_, mouse.place} : KeptObject();
}

void MousePointer::keep(const std::optional<Eigen::Vector2d>& place) {
  const std::lock_guard<std::mutex> lock(mutex_);
  kept_ = place ? KeptObject{++clicks_, *place} : KeptObject();
}

std::optional<Eigen::Vector2d> MousePointer::place() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return place_;
}

KeptObject MousePointer::kept(const PictureTurn& turn) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return {kept_.click, turn.place_shown(kept_.place)};
}

void MousePointer::let_go(uint32_t click) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (kept_.click == click) kept_ = {};
}

void MousePointer::reset() {
  const std::lock_guard<std::mutex> lock(mutex_);
  place_.reset();
  kept_ = {};
}

}  // namespace spidar
