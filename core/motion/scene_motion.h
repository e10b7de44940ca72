// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Which motion of the picture is felt.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/api.h"
#include "core/motion/image_motion.h"
#include "core/motion/motion_models.h"
#include "core/motion/moving_object.h"
#include "core/tracking/tracker.h"

namespace spidar {

enum class MotionKind {
  kMean,     ///< mean velocity of all points: the paper's eq. 9–10
  kObject,   ///< the dominant object against the background
  kObjects,  ///< all objects against the background, weighted by area and nearness to the pointer
  kCamera,   ///< what the camera does
};

/// How far from the pointer an object is still felt: σ of the Gaussian kernel, a share of the
/// frame's height.
constexpr double kPointerReach = 0.25;

/// Mean motion of the objects, each weighted by area_px2 · exp(−d² / 2σ²), d the distance of
/// `pointer_px` (from the frame's centre) from the nearest edge of the object's box, 0 within it.
/// An object at the pointer counts by its size alone; what is a quarter of the frame's height away
/// counts 0.61, half of it 0.14, all of it 0.0003 of that. A single object is felt as it is,
/// wherever it is: the pointer chooses, it does not weaken. Objects at rest count, those out of
/// sight do not.
SPIDAR_API ImageMotion motion_at_pointer(const std::vector<MovingObject>& objects,
                                         const Eigen::Vector2d& pointer_px, int frame_height);

/// What two successive frames say.
struct SceneMotion {
  ImageMotion felt;
  /// Nothing to compare with: the first frame, another size, or a cut. Nothing is felt.
  bool restarted = false;
  /// Of the background; nothing with kMean, which looks at no model.
  std::optional<ModelKind> model;
  /// Of the camera: where the background goes to the left it goes to the right, where the
  /// background grows it goes in. Zero with kMean.
  ImageMotion camera;
  int objects = 0;  ///< that are known, seen or not; 0 with kMean and kCamera
  /// What was found, in detail: valid until the next estimate(). Null with
  /// kMean; no objects with kCamera either.
  const Background* background = nullptr;
  const std::vector<MovingObject>* object_list = nullptr;  ///< in the order of birth
  /// Points that were followed, and blocks without one that show how they moved.
  const std::vector<Track>* tracks = nullptr;
  int features = 0;  ///< that will be looked for in the next frame
  /// The object that `object` follows, one of the list; null while there is none.
  const MovingObject* dominant = nullptr;
};

}  // namespace spidar
