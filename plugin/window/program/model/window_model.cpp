// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/program/model/window_model.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "plugin/window/program/model/timeline.h"

namespace spidar {

std::string count_of(size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::vector<uint32_t> felt_objects(const FrameFacts& facts) {
  return felt_objects(facts.scene, facts.motion, facts.touch);
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
