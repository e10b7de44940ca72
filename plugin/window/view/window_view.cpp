// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/view/window_view.h"

#include <algorithm>
#include <cstdio>

namespace spidar {

const Setting* ElementState::setting(const std::string& setting_name) const {
  const auto found = std::find_if(settings.begin(), settings.end(),
                                  [&](const Setting& s) { return s.name == setting_name; });
  return found == settings.end() ? nullptr : &*found;
}

double ElementState::value(const std::string& setting_name, double otherwise) const {
  const Setting* found = setting(setting_name);
  return found ? found->value : otherwise;
}

std::string felt_line(const ElementState& state, const TouchScene& touch) {
  if (!state.no_force.empty()) return "not felt: " + state.no_force;
  const double wanted_N_m = state.value("touch-stiffness", 0);
  if (!touch.on || touch.stiffness_N_m >= wanted_N_m) return "felt";
  char text[96];
  std::snprintf(text, sizeof text,
                "felt, at %.0f N/m instead of %.0f: the device's drives are slow",
                touch.stiffness_N_m, wanted_N_m);
  return text;
}

double controller_speed_px_s(const ImageMotion& motion, const AxisGains& gains, int frame_height) {
  if (frame_height <= 0) return 0;
  const Eigen::Vector2d velocity_px_s =
      motion.velocity_px_s * (kReferenceHeight_px / static_cast<double>(frame_height));
  return Eigen::Vector4d(velocity_px_s.x(), velocity_px_s.y(),
                         gains.depth * motion.growth_1_s * kRim_px,
                         gains.roll * motion.roll_rad_s * kRim_px)
      .norm();
}

}  // namespace spidar
