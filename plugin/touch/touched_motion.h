// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How what is under the finger has moved.
#pragma once

#include <Eigen/Core>

#include "core/motion_analyzer.h"

namespace spidar {

/// From the frame before to this one, in pixels of the frame: x right, y down. `place`: of the
/// finger, (0, 0) is the top left corner of the picture and (1, 1) its bottom right one. It is the
/// motion of the object whose box the finger is in (of several the one of the least area), else
/// that of the background there; with motion=mean, which looks for neither, that of the whole
/// picture. Zero where nothing is known, and for a frame that shows the picture before again.
Eigen::Vector2d touched_displacement_px(const FrameAnalysis& frame, const Eigen::Vector2d& place);

}  // namespace spidar
