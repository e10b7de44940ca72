// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/model/window_model.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "plugin/window/model/timeline.h"

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

std::string count_of(size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::vector<uint32_t> felt_objects(const FrameFacts& facts) {
  return felt_objects(facts.scene, facts.settings.motion, facts.touch);
}

std::string felt_line(const ElementState& state, const TouchScene& touch) {
  if (state.limit != NoForceReason::kNone) return std::string("not felt: ") + sentence(state.limit);
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
  const double radius_px = kReferenceHeight_px / 2;
  return Eigen::Vector4d(velocity_px_s.x(), velocity_px_s.y(),
                         gains.depth * motion.growth_1_s * radius_px,
                         gains.roll * motion.roll_rad_s * radius_px)
      .norm();
}

std::vector<double> gain_curve(const ControllerSettings& settings, const Timeline& timeline,
                               double highest_px_s, int points) {
  std::vector<double> curve;
  try {
    const std::unique_ptr<GainController> controller = make_controller(settings);
    controller->force_N(timeline.largest_speed_px_s());
    for (const Moment& moment : timeline.plotted()) {
      if (moment.interval_s > 0) controller->force_N({moment.speed_px_s, moment.interval_s});
    }
    for (int i = 0; i < points; ++i) {
      curve.push_back(controller->force_N(highest_px_s * i / std::max(points - 1, 1)));
    }
  } catch (const std::invalid_argument&) {
    curve.clear();
  }
  return curve;
}

}  // namespace spidar
