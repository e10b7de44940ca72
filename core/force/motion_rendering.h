// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include "core/force/gain_controller.h"
#include "core/motion/image_motion.h"
#include "core/points/tracker.h"
#include "core/require.h"
#include "core/wrench_size.h"

namespace spidar {

/// Gains of the axes that the paper leaves out, finite and ≥ 0; 0 turns an axis off. At 1, growth
/// and roll count as the speed at which they move a point half a frame height away.
struct AxisGains {
  double depth = 1;  ///< of growth: force towards the viewer
  double roll = 1;   ///< of roll: torque about the view axis
};

/// Throws std::invalid_argument when a gain is out of range.
inline void validate(const AxisGains& gains) {
  require_not_negative("depth gain", gains.depth);
  require_not_negative("roll gain", gains.roll);
}

/// Growth and roll count as the speed at which they move a point at this distance from the centre:
/// half the height of the reference frame.
constexpr double kRim_px = kReferenceHeight_px / 2;

/// Velocity, growth and roll as speeds in px/s of the reference frame: u = (v_x, v_y, depth ·
/// growth · R, roll gain · roll · R) with R = kRim_px. `frame_height` > 0.
inline Eigen::Vector4d reference_speeds_px_s(const ImageMotion& motion, const AxisGains& gains,
                                             int frame_height) {
  const Eigen::Vector2d velocity_px_s = kReferenceHeight_px / frame_height * motion.velocity_px_s;
  return {velocity_px_s.x(), velocity_px_s.y(), gains.depth * motion.growth_1_s * kRim_px,
          gains.roll * motion.roll_rad_s * kRim_px};
}

/// The wrench for a motion in a frame of `frame_height` pixels, in the device frame D.
///
/// The controller converts |u| of reference_speeds_px_s() to a force F, which is distributed in
/// proportion to u. The force is F (u₁, −u₂, u₃) / |u|, because y points down in the picture and up
/// in the device. The torque about z, which points to the viewer, is −F kTorqueArm_m u₄ / |u|,
/// because a clockwise turn on the screen turns from x to −y of the device. The force therefore
/// never exceeds F, and the torque never exceeds F times the arm. `interval_s` is the running time
/// since the previous frame, 0 if unknown.
inline Wrench render_motion(GainController& controller, const ImageMotion& motion,
                            const AxisGains& gains, int frame_height, double interval_s = 0) {
  const Eigen::Vector4d u = reference_speeds_px_s(motion, gains, frame_height);
  const double dead_zone_px_s = kReferenceHeight_px / frame_height * motion.dead_zone_px_s;
  const double speed_px_s = u.norm();
  const double force_N = controller.force_N(speed_px_s, interval_s, dead_zone_px_s);
  Wrench wrench;
  if (!(speed_px_s > 0)) return wrench;
  const Eigen::Vector4d direction = u / speed_px_s;
  wrench.force_N << force_N * direction[0], -force_N * direction[1], force_N * direction[2];
  wrench.torque_Nm.z() = 0 - force_N * kTorqueArm_m * direction[3];  // 0 − avoids −0 without roll
  return wrench;
}

}  // namespace spidar
