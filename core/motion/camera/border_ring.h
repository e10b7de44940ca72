// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What the border of the picture says about the motion of the camera.
#pragma once

#include "core/motion/camera/block_votes.h"

namespace spidar {

/// Whether the blocks along the border, with texture or without, fit the picture before better if
/// they have moved like the model than if they rest. Known objects are left out; where they have
/// most of the border, it says nothing.
bool border_has_moved(const BlockField& field, const Past& past, const MotionModel& model);

}  // namespace spidar
