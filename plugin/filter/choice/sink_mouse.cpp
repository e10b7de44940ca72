// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/choice/sink_mouse.h"

#include <algorithm>
#include <cmath>

#include <gst/video/navigation.h>
#include <gst/video/video.h>

#include "plugin/gobject/ref.h"

namespace spidar::filter {
namespace {

constexpr gint kLeftButton = 1, kWheelUp = 4, kWheelDown = 5;  // X sinks send the wheel as buttons

/// Clamps to 0 … 1, because the mouse may be beside the picture, in the black bars of a window.
double fraction(double at_px, int size_px) {
  if (!std::isfinite(at_px) || size_px <= 0) return 0.5;
  return std::min(std::max(at_px / size_px, 0.0), 1.0);
}

std::optional<GstVideoInfo> info_of(GstPad* pad) {
  const Ref<GstCaps> caps(gst_pad_get_current_caps(pad));
  GstVideoInfo info;
  const bool known = caps && gst_video_info_from_caps(&info, caps.get());
  return known ? std::optional<GstVideoInfo>(info) : std::nullopt;
}

/// Parses a mouse event; the position in the result is in pixels.
std::optional<SinkMouse> parse(GstEvent* event) {
  SinkMouse mouse;
  gdouble &x = mouse.position.x(), &y = mouse.position.y(), sideways = 0;
  gint button = 0;
  switch (gst_navigation_event_get_type(event)) {
    case GST_NAVIGATION_EVENT_MOUSE_MOVE:
      if (!gst_navigation_event_parse_mouse_move_event(event, &x, &y)) return std::nullopt;
      return mouse;
    case GST_NAVIGATION_EVENT_MOUSE_SCROLL:
      mouse.act = SinkMouse::Act::kWheel;
      if (!gst_navigation_event_parse_mouse_scroll_event(event, &x, &y, &sideways, &mouse.wheel)) {
        return std::nullopt;
      }
      return mouse;
    case GST_NAVIGATION_EVENT_MOUSE_BUTTON_PRESS:
      mouse.act = SinkMouse::Act::kPress;
      break;
    case GST_NAVIGATION_EVENT_MOUSE_BUTTON_RELEASE:
      mouse.act = SinkMouse::Act::kRelease;
      break;
    default:
      return std::nullopt;
  }
  if (!gst_navigation_event_parse_mouse_button_event(event, &button, &x, &y)) return std::nullopt;
  if (button == kLeftButton) return mouse;
  const bool is_wheel = button == kWheelUp || button == kWheelDown;
  if (!is_wheel || mouse.act == SinkMouse::Act::kRelease) return std::nullopt;
  mouse.act = SinkMouse::Act::kWheel;
  mouse.wheel = button == kWheelUp ? 1 : -1;
  return mouse;
}

}  // namespace

std::optional<SinkMouse> read_mouse(GstEvent* event, GstPad* source) {
  std::optional<SinkMouse> mouse = parse(event);
  const std::optional<GstVideoInfo> info = mouse ? info_of(source) : std::nullopt;
  if (!info) return std::nullopt;
  mouse->position = {fraction(mouse->position.x(), info->width),
                     fraction(mouse->position.y(), info->height)};
  if (!std::isfinite(mouse->wheel)) mouse->wheel = 0;
  GstNavigationModifierType keys = GST_NAVIGATION_MODIFIER_NONE;
  mouse->shift = gst_navigation_event_parse_modifier_state(event, &keys) &&
                 (keys & GST_NAVIGATION_MODIFIER_SHIFT_MASK) != 0;
  return mouse;
}

void MousePointer::update(const SinkMouse& mouse) {
  const bool clicks = mouse.act == SinkMouse::Act::kPress;
  if (!clicks && mouse.act != SinkMouse::Act::kMove) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  position_ = mouse.position;
  if (clicks) kept_ = kept_.click == 0 ? KeptObject{++clicks_, mouse.position} : KeptObject();
}

void MousePointer::keep(const std::optional<Eigen::Vector2d>& position) {
  const std::lock_guard<std::mutex> lock(mutex_);
  kept_ = position ? KeptObject{++clicks_, *position} : KeptObject();
}

std::optional<Eigen::Vector2d> MousePointer::position() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return position_;
}

KeptObject MousePointer::kept() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return kept_;
}

void MousePointer::release(uint32_t click) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (kept_.click == click) kept_ = {};
}

void MousePointer::reset() {
  const std::lock_guard<std::mutex> lock(mutex_);
  position_.reset();
  kept_ = {};
}

}  // namespace spidar::filter
