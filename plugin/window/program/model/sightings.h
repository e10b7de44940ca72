// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// When and where the objects of a scene were seen first.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "plugin/window/view/window_view.h"

namespace spidar {

struct Sighting {
  uint32_t id = 0;
  int64_t first_ns = -1;              ///< in the film; −1: not known
  Eigen::Vector2d first_place{0, 0};  ///< a share of the picture as it is shown
  int64_t last_ns = -1;
};

/// Of the scene that is on the screen.
class Sightings {
 public:
  /// An object that has been out of sight for longer is forgotten: were it seen again, it would be
  /// another one.
  static constexpr int64_t kForgotten_ns = 2'000'000'000;

  /// The next frame that is on the screen. Another scene or film forgets all.
  void see(const FrameFacts& facts);
  /// Null when it is not known.
  const Sighting* find(uint32_t id) const;

 private:
  std::vector<Sighting> seen_;
  FilmMoment film_;
};

}  // namespace spidar
