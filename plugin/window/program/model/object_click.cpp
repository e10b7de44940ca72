// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/program/model/object_click.h"

#include <array>

namespace spidar {

const MovingObject* object_at(const FrameReport& report, const Eigen::Vector2d& place) {
  const Eigen::Vector2d at_px((place.x() - 0.5) * report.visible.width,
                              (place.y() - 0.5) * report.visible.height);
  const MovingObject* found = nullptr;
  for (const MovingObject& object : report.frame.objects) {
    const Eigen::Vector2d off_px = (at_px - object.position_px).cwiseAbs();
    if (object.tracks == 0 || (off_px.array() > object.size_px.array() / 2).any()) continue;
    if (!found || object.size_px.prod() < found->size_px.prod()) found = &object;
  }
  return found;
}

Eigen::Vector2d place_of(const FrameReport& report, const MovingObject& object) {
  const Eigen::Vector2d frame_px(report.visible.width, report.visible.height);
  const Eigen::Vector2d middle_px = object.position_px + frame_px / 2, none(0, 0);
  const Eigen::Vector2d low_px = (middle_px - object.size_px / 2).cwiseMax(none).cwiseMin(frame_px);
  const Eigen::Vector2d high_px =
      (middle_px + object.size_px / 2).cwiseMax(none).cwiseMin(frame_px);
  const auto place_at = [&](double across, double down) -> Eigen::Vector2d {
    const Eigen::Vector2d share(across, down);
    return (low_px + share.cwiseProduct(high_px - low_px))
        .cwiseQuotient(frame_px.cwiseMax(Eigen::Vector2d(1, 1)));
  };
  constexpr std::array<double, 5> kShares{0.5, 0.3, 0.7, 0.1, 0.9};  // the middle first
  for (const double down : kShares) {
    for (const double across : kShares) {
      const MovingObject* const there = object_at(report, place_at(across, down));
      if (there && there->id == object.id) return place_at(across, down);
    }
  }
  return place_at(0.5, 0.5);
}

bool offers_choice(const FrameReport& report) {
  return report.motion != MotionKind::kMean && !report.touch.on;
}

std::optional<ObjectWish> ObjectClick::update(const Mouse& mouse, const Rect& picture,
                                              const FrameReport& report) {
  const bool pressed = mouse.down && !was_down_;
  was_down_ = mouse.down;
  holds_ = holds_ && mouse.down;
  if (!pressed || mouse.taken || !offers_choice(report) || picture.width <= 0) return std::nullopt;
  const Eigen::Vector2d place((mouse.at_px.x() - picture.x) / picture.width,
                              (mouse.at_px.y() - picture.y) / picture.height);
  // Not a number where there is no mouse.
  const bool is_over = place.x() >= 0 && place.x() <= 1 && place.y() >= 0 && place.y() <= 1;
  const MovingObject* const object = is_over ? object_at(report, place) : nullptr;
  if (!object) return std::nullopt;
  holds_ = true;
  const bool is_chosen = report.click != 0 && report.frame.felt_object == object->id;
  ObjectWish wish;
  wish.object = object->id;
  if (!is_chosen) wish.place = place;
  return wish;
}

}  // namespace spidar
