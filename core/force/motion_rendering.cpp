// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/force/motion_rendering.h"

#include "core/require.h"

namespace spidar {
void validate(const AxisGains& gains) {
  require_not_negative("depth gain", gains.depth);
  require_not_negative("roll gain", gains.roll);
}

Wrench render_motion(GainController& controller, const ImageMotion& motion, const AxisGains& gains,
                     int frame_height, double interval_s) {
  const Eigen::Vector2d velocity_px_s = kReferenceHeight_px / frame_height * motion.velocity_px_s;
  const double noise_px_s = kReferenceHeight_px / frame_height * motion.noise_px_s;
  const double depth_px_s = gains.depth * motion.growth_1_s * kRim_px;
  const double roll_px_s = gains.roll * motion.roll_rad_s * kRim_px;
  // Without growth and roll this is the plane controller to the last bit.
  if (depth_px_s == 0 && roll_px_s == 0) {
    return render_motion(controller, velocity_px_s, interval_s, noise_px_s);
  }

  const Eigen::Vector4d u(velocity_px_s.x(), velocity_px_s.y(), depth_px_s, roll_px_s);
  const double speed_px_s = u.norm();
  const double force_N = controller.force_N({speed_px_s, interval_s, noise_px_s});
  const Eigen::Vector4d direction = u / speed_px_s;
  Wrench wrench;
  wrench.force_N << force_N * direction[0], -force_N * direction[1], force_N * direction[2];
  wrench.torque_Nm.z() = -force_N * kTorqueArm_m * direction[3];
  return wrench;
}

}  // namespace spidar
