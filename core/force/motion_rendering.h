// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Converts the motion of the picture to a wrench in six degrees of freedom.
#pragma once

#include "core/force/gain_controller.h"
#include "core/motion/image_motion.h"
#include "core/tracking/tracker.h"
#include "core/wrench.h"

namespace spidar {

/// Gains of the axes that the paper leaves out, finite and ≥ 0; 0 turns an axis off. At 1, growth
/// and roll count as the speed at which they move a point half a frame height away.
struct AxisGains {
  double depth = 1;  ///< of growth: force towards the viewer
  double roll = 1;   ///< of roll: torque about the view axis
};

/// Throws std::invalid_argument when a gain is out of range.
void validate(const AxisGains& gains);

/// Growth and roll count as the speed at which they move a point at this distance from the centre:
/// half the height of the reference frame.
constexpr double kRim_px = kReferenceHeight_px / 2;

/// Lever arm of the torque: the radius of the grip.
constexpr double kTorqueArm_m = 0.0225;

/// The wrench for a motion in a frame of `frame_height` pixels, in the device frame D.
///
/// Velocity, growth and roll become speeds in px/s of the reference frame, u = (v_x, v_y,
/// depth · growth · R, roll gain · roll · R) with R = kRim_px. The controller
/// turns |u| into a force F, which is divided in proportion to u: the force is F (u₁, −u₂, u₃) /
/// |u|, because y points down in the picture and up in the device; the torque about z, which points
/// to the viewer, is −F kTorqueArm_m u₄ / |u|, because a clockwise turn on the screen turns from x
/// to −y of the device. The force therefore never exceeds F, and the torque never exceeds F times
/// the arm. `interval_s` is the running time since the previous frame, 0 if unknown.
Wrench render_motion(GainController& controller, const ImageMotion& motion, const AxisGains& gains,
                     int frame_height, double interval_s = 0);

}  // namespace spidar
