// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/choice/mouse_pointer.h"

#include <algorithm>
#include <cmath>

#include <gst/video/navigation.h>
#include <gst/video/video.h>

namespace spidar {
namespace {

constexpr gint kLeftButton = 1;

/// The mouse may be beside the picture, in the black bars of a window.
double share(double at_px, int size_px) {
  if (!std::isfinite(at_px) || size_px <= 0) return 0.5;
  return std::min(std::max(at_px / size_px, 0.0), 1.0);
}

std::optional<GstVideoInfo> info_of(GstPad* pad) {
  GstCaps* const caps = gst_pad_get_current_caps(pad);
  GstVideoInfo info;
  const bool known = caps && gst_video_info_from_caps(&info, caps);
  if (caps) gst_caps_unref(caps);
  return known ? std::optional<GstVideoInfo>(info) : std::nullopt;
}

}  // namespace

void MousePointer::take(GstEvent* event, GstPad* source) {
  gdouble x = 0, y = 0;
  gint button = 0;
  const GstNavigationEventType type = gst_navigation_event_get_type(event);
  const bool moves = type == GST_NAVIGATION_EVENT_MOUSE_MOVE &&
                     gst_navigation_event_parse_mouse_move_event(event, &x, &y);
  const bool clicks = type == GST_NAVIGATION_EVENT_MOUSE_BUTTON_PRESS &&
                      gst_navigation_event_parse_mouse_button_event(event, &button, &x, &y) &&
                      button == kLeftButton;
  if (!moves && !clicks) return;
  const std::optional<GstVideoInfo> info = info_of(source);
  if (!info) return;
  const Eigen::Vector2d place(share(x, info->width), share(y, info->height));
  const std::lock_guard<std::mutex> lock(mutex_);
  place_ = place;
  if (!clicks) return;
  kept_ = kept_.click == 0 ? KeptObject{++clicks_, place} : KeptObject();
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
