// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The motions that can be rendered: the paper's mean, the motion of an object, of the objects at a
/// pointer or in a box, and of the camera; and the limits of a motion.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "core/motion/camera/motion_models.h"
#include "core/motion/objects/moving_object.h"
#include "core/points/tracker.h"

namespace spidar {

enum class MotionKind {
  kMean,    ///< mean velocity of the points of OpenCvTracker: the paper's eq. 1–10
  kObject,  ///< motion of the dominant object relative to the background
  /// All objects relative to the background, weighted by size and nearness to the pointer.
  kObjects,
  kCamera,  ///< motion of the camera
};

/// The dead zone of ControlLaw::kAdaptive: a slower motion may be a measurement error that changes
/// from frame to frame.
struct DeadZone {
  /// For a velocity whose standard error σ in each coordinate is known, in σ: for a Gaussian error
  /// of two coordinates P(|e| > 3 σ) = 1.1 %.
  static constexpr double kSigmas = 3;
  /// For an object, as a fraction of MovingObject::error_px_s, below which 95 % of its errors lie.
  /// Chosen for little loss of force, not derived: on films, the part of the error that changes
  /// from frame to frame had a standard error of 1/25 of the bound. In ten rendered clips with
  /// noise and coding, it is 0.06 to 0.85 of the bound, so the force of an object that is slower
  /// than its bound may tremble. With the whole bound as the dead zone, the median force of
  /// `adaptive` on films falls from 0.98 to 0.82 N.
  static constexpr double kOfBound = kSigmas / 25;
  /// For a motion whose error is unknown, px/s of the reference frame: the speed at which eq. 15
  /// with α = 0.01 and Fmax = 3 N gives 0.04 N, the smallest force that is felt (IEEE Trans.
  /// Haptics 2013, PubMed 24808327): tan(0.04 π / 6) / 0.01.
  static constexpr double kUnknownError_px_s = 2.1;
};

struct ImageMotion {
  Eigen::Vector2d velocity_px_s = Eigen::Vector2d::Zero();  ///< image frame I: x right, y down
  /// Relative change of lengths per second: 0.5 is half as large again, and the picture comes
  /// nearer.
  double growth_1_s = 0;
  double roll_rad_s = 0;      ///< rotation from x to y: clockwise on the screen
  int tracked = 0;            ///< number of measured points
  double dead_zone_px_s = 0;  ///< see DeadZone; 0: the error is unknown
};

/// The paper's frame velocity (eq. 9–10): mean over all points of displacement / Δt. `interval_ns`
/// is the difference of the frames' running times and must be positive. Without points the velocity
/// is 0 and `tracked` is 0.
ImageMotion mean_motion(const std::vector<FollowedPoint>& points, int64_t interval_ns);

/// How far from the pointer an object is felt: σ of the Gaussian weight, as a fraction of the
/// frame's height.
constexpr double kPointerReach = 0.25;

/// Mean motion of the objects, each weighted by area_px2 · exp(−d² / 2σ²), where d is the distance
/// of `pointer_px` (from the frame's centre) from the nearest edge of the object's box, 0 inside
/// it. An object at the pointer counts with its full size; at a distance of a quarter of the
/// frame's height the factor is 0.61, at half of it 0.14, at the full height 0.0003. The weights
/// are normalised, so a single object is felt at full strength everywhere. Objects at rest count,
/// invisible objects do not.
ImageMotion motion_at_pointer(const std::vector<MovingObject>& objects,
                              const Eigen::Vector2d& pointer_px, int frame_height);

/// Mean motion of the visible objects, each weighted by the part of its box in a box of the frame,
/// px from the frame's centre.
ImageMotion motion_in_box(const std::vector<MovingObject>& objects,
                          const Eigen::AlignedBox2d& box_px);

/// Motion of the camera over `interval_s` > 0: the camera moves to the right when the background
/// moves to the left, and forwards when the background grows. `votes` is the number of
/// displacements of the background.
ImageMotion camera_motion(const Background& background, int votes, double interval_s);

ImageMotion relative_motion(const MovingObject& object);

/// The shortest assumed interval between two frames: half a tick of the haptic loop. A displacement
/// must not be divided by the rounding error of timestamps.
constexpr int64_t kMinInterval_ns = 500'000;

/// `motion`, limited to what can be seen in `interval_s` > 0: a displacement of the frame's width,
/// lengths twice or half as large, half a turn. Directions are kept. A value that is not finite
/// becomes 0.
ImageMotion bound_motion(const ImageMotion& motion, int frame_width, double interval_s);

}  // namespace spidar
