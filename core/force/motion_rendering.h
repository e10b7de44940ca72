// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How a motion of the picture is felt, in six degrees of freedom.
#pragma once

#include "core/api.h"
#include "core/force/gain_controller.h"
#include "core/motion/image_motion.h"
#include "core/tracking/tracker.h"
#include "core/wrench.h"

namespace spidar {

/// Gains of the axes that the paper leaves out, finite and ≥ 0; 0 turns an axis off. At 1 a growth
/// or turn weighs as much as the speed that it gives to a point half the frame's height away.
struct AxisGains {
  double depth = 1;  ///< of growth: force towards the viewer
  double roll = 1;   ///< of roll: torque about the view axis
};

/// Throws std::invalid_argument when a gain is out of range.
SPIDAR_API void validate(const AxisGains& gains);

/// Growth and roll count by the speed that they give to a point so far from the middle: half the
/// height of the reference frame.
constexpr double kRim_px = kReferenceHeight_px / 2;

/// Arm of the torque: the grip's radius.
constexpr double kTorqueArm_m = 0.0225;

/// Wrench of a motion seen in a frame of `frame_height` pixels, in the device frame D.
///
/// Velocity, growth and roll become speeds in px/s of the reference frame, u = (v_x, v_y,
/// depth · growth · R, roll gain · roll · R) with R = kRim_px. The controller
/// sees |u| once, and its force F is shared in the ratios of u: force F (u₁, −u₂, u₃) / |u|, for y
/// is down in the picture and up in the device, and torque about z, towards the viewer, −F
/// kTorqueArm_m u₄ / |u|, for what turns clockwise on the screen turns from x to −y of the device.
/// So the force never exceeds that of the controller, nor the torque that times the arm.
/// `interval_s` is the running time since the frame before, 0 when it is not known.
SPIDAR_API Wrench render_motion(GainController& controller, const ImageMotion& motion,
                                const AxisGains& gains, int frame_height, double interval_s = 0);

}  // namespace spidar
