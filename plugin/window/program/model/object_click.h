// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "plugin/window/view/mouse_hand.h"
#include "plugin/window/view/window_view.h"

namespace spidar::window {

/// Returns the visible object whose box contains the position, the smallest of several; null when
/// there is none. Positions are fractions of the visible part of the frame.
inline const MovingObject* object_at(const DrawnFrame& report, const Eigen::Vector2d& position) {
  const Eigen::Vector2d at_px = report.frame.place.film_px(position);
  const MovingObject* found = nullptr;
  for (const MovingObject& object : report.frame.objects) {
    const Eigen::Vector2d off_px = (at_px - object.position_px).cwiseAbs();
    if (object.points == 0 || (off_px.array() > object.size_px.array() / 2).any()) continue;
    if (!found || object.size_px.prod() < found->size_px.prod()) found = &object;
  }
  return found;
}

/// Returns a position in the box of this object and in no smaller one, if there is one: a click
/// there means this object. As a fraction of the visible part of the frame.
inline Eigen::Vector2d position_of(const DrawnFrame& report, const MovingObject& object) {
  const FilmPlace& place = report.frame.place;
  const Eigen::Vector2d frame_px(place.picture_width, place.picture_height), none(0, 0);
  const Eigen::Vector2d middle_px = object.position_px - place.film_px(none);
  const Eigen::Vector2d low_px = (middle_px - object.size_px / 2).cwiseMax(none).cwiseMin(frame_px);
  const Eigen::Vector2d high_px =
      (middle_px + object.size_px / 2).cwiseMax(none).cwiseMin(frame_px);
  const auto position_at = [&](double across, double down) -> Eigen::Vector2d {
    const Eigen::Vector2d fraction(across, down);
    return (low_px + fraction.cwiseProduct(high_px - low_px))
        .cwiseQuotient(frame_px.cwiseMax(Eigen::Vector2d(1, 1)));
  };
  constexpr std::array<double, 5> kShares{0.5, 0.3, 0.7, 0.1, 0.9};  // the middle first
  for (const double down : kShares) {
    for (const double across : kShares) {
      const MovingObject* const there = object_at(report, position_at(across, down));
      if (there && there->id == object.id) return position_at(across, down);
    }
  }
  return position_at(0.5, 0.5);
}

/// Whether objects are known, and the picture is not touched.
inline bool offers_choice(const DrawnFrame& report) {
  return report.motion != MotionKind::kMean && !report.touch.on;
}

/// The request of a click.
struct ChoiceRequest {
  std::optional<Eigen::Vector2d>
      position;         ///< of the object that is felt from now on; none: release
  uint32_t object = 0;  ///< the clicked object
};

/// Chooses the object on which the left button is pressed; on the chosen object, releases it. Where
/// no object is, and while the picture is touched, the button belongs to the hand.
class ObjectClick {
 public:
  /// `picture` is the part of the window that shows the visible part of the frame. Returns nothing
  /// when no object was clicked.
  std::optional<ChoiceRequest> update(const Mouse& mouse, const Rect& picture,
                                      const DrawnFrame& report) {
    const bool pressed = mouse.down && !was_down_;
    was_down_ = mouse.down;
    holds_ = holds_ && mouse.down;
    if (!pressed || mouse.taken || !offers_choice(report) || picture.width <= 0) {
      return std::nullopt;
    }
    const Eigen::Vector2d position((mouse.at_px.x() - picture.x) / picture.width,
                                   (mouse.at_px.y() - picture.y) / picture.height);
    // The position is not a number where there is no mouse.
    const bool is_over =
        position.x() >= 0 && position.x() <= 1 && position.y() >= 0 && position.y() <= 1;
    const MovingObject* const object = is_over ? object_at(report, position) : nullptr;
    if (!object) return std::nullopt;
    holds_ = true;
    const bool is_chosen = report.click != 0 && report.frame.felt_object == object->id;
    ChoiceRequest request;
    request.object = object->id;
    if (!is_chosen) request.position = position;
    return request;
  }
  bool holds() const { return holds_; }

 private:
  bool was_down_ = false;
  bool holds_ = false;
};

}  // namespace spidar::window
