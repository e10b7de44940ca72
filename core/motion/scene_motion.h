// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The motions of a frame that can be felt: of an object, of the objects at a pointer or in a box,
/// of the camera.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/motion/camera/background.h"
#include "core/motion/camera/motion_models.h"
#include "core/motion/image_motion.h"
#include "core/motion/objects/moving_object.h"
#include "core/tracking/tracker.h"

namespace spidar {

enum class MotionKind {
  kMean,    ///< mean velocity of the points of OpenCvTracker: the paper's eq. 1–10
  kObject,  ///< motion of the dominant object relative to the background
  /// All objects relative to the background, weighted by area and nearness to the pointer.
  kObjects,
  kCamera,  ///< motion of the camera
};

/// How far from the pointer an object is felt: σ of the Gaussian weight, as a fraction of the
/// frame's height.
constexpr double kPointerReach = 0.25;

/// Standard error of an object's velocity as it changes from frame to frame, as a fraction of
/// MovingObject::error_px_s, most of which lasts for many frames. With 1/25, the dead zone of
/// AdaptiveController is that of the noise of points: in five real films its force is within 1.4 %.
constexpr double kNoiseOfError = 0.04;

/// Mean motion of the objects, each weighted by area_px2 · exp(−d² / 2σ²), where d is the distance
/// of `pointer_px` (from the frame's centre) from the nearest edge of the object's box, 0 inside
/// it. An object at the pointer counts with its full area; at a distance of a quarter of the
/// frame's height the factor is 0.61, at half of it 0.14, at the full height 0.0003. A single
/// object is felt at full strength wherever it is, because the weights are normalised. Objects at
/// rest count, objects out of sight do not.
ImageMotion motion_at_pointer(const std::vector<MovingObject>& objects,
                              const Eigen::Vector2d& pointer_px, int frame_height);

/// Mean motion of the objects in sight, each weighted by the area that it has in a box of the
/// frame, px from the frame's centre: the box around it stands for its outline.
ImageMotion motion_in_box(const std::vector<MovingObject>& objects,
                          const Eigen::AlignedBox2d& box_px);

/// Motion of the camera over `interval_s` > 0: it moves to the right when the background moves to
/// the left, and forwards when the background grows. `votes` is the number of displacements that
/// the background was found from.
ImageMotion camera_motion(const Background& background, int votes, double interval_s);

/// The motion of this object alone.
ImageMotion motion_of(const MovingObject& object);

}  // namespace spidar
