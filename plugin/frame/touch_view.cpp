// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/frame/touch_view.h"

#include <algorithm>

namespace spidar {
namespace {

/// Maps −half … half to 0 … 1.
double fraction(double at_m, double half_m) {
  if (!(half_m > 0)) return 0.5;
  return std::min(std::max(0.5 + at_m / (2 * half_m), 0.0), 1.0);
}

// In a picture 480 lines high.
constexpr double kFinger_px = 11, kMinProxy_px = 3, kMaxProxy_px = 9;

double at_height_px(double at_480, double height_px) {
  return std::max(at_480 * height_px / 480, 1.5);
}

}  // namespace

GripPointer::GripPointer(const StringGeometry& geometry, const Orientation& turn)
    : half_size_m_(half_picture_m(geometry)), turn_(turn) {}

Eigen::Vector2d GripPointer::position(const Eigen::Vector3d& position_m) const {
  return turn_.stored_position(
      {fraction(position_m.x(), half_size_m_.x()), fraction(-position_m.y(), half_size_m_.y())});
}

Eigen::Vector2d GripPointer::position_m(const Eigen::Vector2d& position) const {
  const Eigen::Vector2d in_picture = turn_.displayed_position(position.cwiseMax(0.0).cwiseMin(1.0));
  return {(2 * in_picture.x() - 1) * half_size_m_.x(), (1 - 2 * in_picture.y()) * half_size_m_.y()};
}

std::optional<TouchMark> touch_mark(const TouchScene& scene, const TickRecord& tick) {
  const bool runs = tick.device == DeviceState::kRunning || tick.device == DeviceState::kIdle;
  if (!scene.on || !runs) return std::nullopt;
  TouchMark mark;
  mark.finger = scene.pointer.position(tick.pose.position_m);
  mark.touching = tick.contact.touching;
  if (mark.touching) {
    mark.proxy = scene.pointer.position(tick.contact.proxy_m);
    mark.force_N = tick.contact.force_N;
  }
  return mark;
}

double finger_radius_px(double height_px) {
  return at_height_px(kFinger_px, height_px);
}

double proxy_radius_px(const TouchMark& mark, double max_force_N, double height_px) {
  const double pressed = max_force_N > 0 ? std::clamp(mark.force_N.z() / max_force_N, 0.0, 1.0) : 0;
  return at_height_px(kMinProxy_px + pressed * (kMaxProxy_px - kMinProxy_px), height_px);
}

}  // namespace spidar
