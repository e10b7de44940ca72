// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The motion of the picture content under the finger.
#pragma once

#include <Eigen/Core>

#include "core/analysis/frame.h"

namespace spidar {

/// Returns the displacement from the previous frame to this one, in pixels of the frame: x right, y
/// down. `place` is the position of the finger, with (0, 0) at the top left corner of the picture
/// and (1, 1) at the bottom right. The result is the motion of the object whose box contains the
/// finger (of several, the one with the smallest area), otherwise that of the background at this
/// point. With motion=mean, which detects neither, it is the motion of the whole picture. Zero if
/// the motion is unknown, or if the frame repeats the previous picture.
Eigen::Vector2d touched_displacement_px(const Frame& frame, const Eigen::Vector2d& place);

}  // namespace spidar
