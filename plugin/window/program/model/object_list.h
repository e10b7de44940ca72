// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The objects of the scene that is on the screen, as a list to choose from.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "plugin/window/program/model/layout.h"
#include "plugin/window/program/model/window_model.h"

namespace spidar {

struct ListedObject {
  uint32_t id = 0;
  size_t slot = 0;        ///< of its picture, below ObjectList::kMost
  int64_t first_ns = -1;  ///< in the film, when it was seen first; −1: not known
  /// Where it was then: a share of the picture as it is shown.
  Eigen::Vector2d first_place{0, 0};
  Eigen::Vector2d place{0, 0};  ///< where it is: a share of the visible part of the frame
  Rect box;  ///< what a picture of it shows, some more than itself, in px of the visible part
  double first_s = 0, seen_s = 0;  ///< running time
  double area_px2 = 0;             ///< of its box, of what of it is in the picture
  double pictured_px2 = 0;         ///< the same when its picture was made; 0: it has none
  bool is_in_sight = false;
  bool is_felt = false;
};

/// "#12".
std::string short_name(uint32_t id);

/// A place that is in the box of this object and in no smaller one, if there is such a place: a
/// click there means it. As a share of the visible part of the frame.
Eigen::Vector2d place_of(const FrameFacts& facts, const MovingObject& object);

/// Objects in the order in which they were seen first. At most kMost are known; more take the
/// places of those that went out of sight.
class ObjectList {
 public:
  static constexpr size_t kMost = 12;
  /// A thing that is seen for a shorter time is not listed, and one that is out of sight for longer
  /// is listed no more.
  static constexpr double kLeast_s = 0.2, kGone_s = 2;
  /// A picture is made anew when the object is so many times as large.
  static constexpr double kBetter = 1.5;

  /// The next frame that is on the screen. Another scene or film empties the list.
  void see(const FrameFacts& facts);

  /// Those that are shown.
  std::vector<const ListedObject*> rows() const;
  /// Null when it is not known; those that are not listed yet are.
  const ListedObject* find(uint32_t id) const;

  /// Those whose picture is to be made from the frame that was seen last.
  std::vector<const ListedObject*> without_picture() const;
  void pictured(uint32_t id);

 private:
  ListedObject* enter(const FrameFacts& facts, const MovingObject& object);

  std::vector<ListedObject> objects_;
  FilmMoment film_;
  double now_s_ = 0;
};

}  // namespace spidar
