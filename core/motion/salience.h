// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How much a region looks like an object, and not like a layer of the scene.
#pragma once

#include "core/motion/regions.h"

namespace spidar {

/// What the camera does, lengths in pixels of the field's picture.
struct CameraMotion {
  double speed_px = 0;  ///< mean over the picture of how far the background has moved
  double still_px = 0;  ///< below this the camera counts as still
  double noise_px = 0;  ///< standard deviation of what follows the background
};

/// Area × speed, px³ of the field's picture, less where the camera moves and the region is what the
/// camera's own translation makes of a scene that is not flat: a layer nearer than the background
/// reaches over the border of the picture, moves the same way as the background and faster, or
/// hardly differs from it or from what no model of the background explains. 0 for what is no object
/// at all. `was_followed`: it was an object before; then it may be a little more like a layer.
double salience(const Region& region, const CameraMotion& camera, bool was_followed);

}  // namespace spidar
