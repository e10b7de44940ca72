// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Scores how much a region looks like an object rather than a layer of the scene.
#pragma once

#include "core/motion/layers/layer_evidence.h"
#include "core/motion/layers/regions.h"

namespace spidar {

/// Motion of the camera, lengths in pixels of the field's picture.
struct CameraMotion {
  bool moves = false;
  double noise_px = 0;  ///< standard deviation of what follows the background
  double blocks = 0;    ///< number of blocks that follow the background
};

/// Whether a region moves against the background by clearly more than the noise around it, which is
/// none while the camera rests.
bool stands_out(const Region& region, const CameraMotion& camera);

/// √area × speed, px² of the field's picture. The score is lower when the camera moves and the
/// region looks like an effect of the camera's translation in a scene with depth: a layer nearer
/// than the background extends over the border of the picture, moves on the screen more than it
/// moves relative to the background, is as large as the background, or hardly differs from the
/// noise around the background's model. 0 for a region that is no object but one of these, or
/// graphics. `was_followed`: it was an object before and may look a little more like a layer, but
/// stand out less from the noise only if it mostly stood out.
double salience(const Region& region, const LayerEvidence& evidence, const CameraMotion& camera,
                bool was_followed);

}  // namespace spidar
