// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/choice/sink_mouse.h"

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

/// With its place in pixels.
std::optional<SinkMouse> parse(GstEvent* event) {
  SinkMouse mouse;
  gdouble &x = mouse.place.x(), &y = mouse.place.y();
  gint button = 0;
  const GstNavigationEventType type = gst_navigation_event_get_type(event);
  mouse.is_press = type == GST_NAVIGATION_EVENT_MOUSE_BUTTON_PRESS;
  if (type == GST_NAVIGATION_EVENT_MOUSE_MOVE) {
    if (!gst_navigation_event_parse_mouse_move_event(event, &x, &y)) return std::nullopt;
  } else if (!mouse.is_press ||
             !gst_navigation_event_parse_mouse_button_event(event, &button, &x, &y) ||
             button != kLeftButton) {
    return std::nullopt;
  }
  return mouse;
}

}  // namespace

std::optional<SinkMouse> read_mouse(GstEvent* event, GstPad* source) {
  std::optional<SinkMouse> mouse = parse(event);
  const std::optional<GstVideoInfo> info = mouse ? info_of(source) : std::nullopt;
  if (!info) return std::nullopt;
  mouse->place = {share(mouse->place.x(), info->width), share(mouse->place.y(), info->height)};
  return mouse;
}

void MousePointer::take(const SinkMouse& mouse) {
  const std::lock_guard<std::mutex> lock(mutex_);
  place_ = mouse.place;
  if (mouse.is_press) kept_ = kept_.click == 0 ? KeptObject{++clicks_, mouse.place} : KeptObject();
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
