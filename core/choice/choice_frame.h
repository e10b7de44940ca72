// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a choice needs of a frame.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/choice/chosen.h"
#include "core/choice/picture_box.h"
#include "core/motion/camera/background.h"
#include "core/motion/objects/moving_object.h"

namespace spidar {

struct ChoiceFrame {
  const std::vector<MovingObject>& objects;
  const Background* background;  ///< null when it is not known
  int width, height;             ///< px
  double interval_s;             ///< since the frame before; 0 when there is none
  bool is_cut;                   ///< nothing in it was in the frame before
  FilmPlace film;
  const PictureBoxes* boxes = nullptr;  ///< that came with it; null: none did

  /// A place of the picture as it is shown, from the middle of the frame.
  Eigen::Vector2d px(const Eigen::Vector2d& place) const {
    return film.in_frame_px(place, width, height);
  }
};

}  // namespace spidar
