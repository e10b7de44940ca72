// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/program/model/setting_text.h"

#include <algorithm>
#include <cmath>

namespace spidar {

const std::vector<SettingGroup>& setting_groups() {
  static const std::vector<SettingGroup> groups{{"Force",
                                                 {{"max-force", "Largest force", "N", 1},
                                                  {"controller", "Speed to force", "", 1},
                                                  {"alpha", "Steepness", "s/px", 1},
                                                  {"depth-gain", "Towards the viewer", "", 1},
                                                  {"roll-gain", "Rotation", "", 1}}},
                                                {"Motion",
                                                 {{"motion", "Which motion", "", 1},
                                                  {"filter-min-cutoff", "Filter at rest", "Hz", 1},
                                                  {"filter-beta", "Filter in motion", "s/px", 1}}},
                                                {"Touch",
                                                 {{"touch", "What is touched", "", 1},
                                                  {"touch-relief", "Height of the relief", "mm", 1},
                                                  {"touch-stiffness", "Stiffness", "N/m", 1},
                                                  {"touch-friction", "Friction", "", 1},
                                                  {"touch-texture", "Texture", "", 1},
                                                  {"motion-share", "Share of the motion", "", 1}}},
                                                {"Timing and errors",
                                                 {{"ts-offset", "Delay of the force", "ms", 1e6},
                                                  {"on-device-error", "Device fails", "", 1}}},
                                                {"Pictures and messages",
                                                 {{"arrow-scale", "Length of arrows", "x", 1},
                                                  {"overlay", "Draw into the video", "", 1},
                                                  {"attach-meta", "Attach metadata", "", 1},
                                                  {"post-messages", "Post messages", "", 1}}}};
  return groups;
}

bool is_changed(const Setting& setting) {
  constexpr double kSliderRounding = 1e-9;
  const double size = std::max(std::abs(setting.value), std::abs(setting.initial));
  return std::abs(setting.value - setting.initial) > kSliderRounding * size;
}

}  // namespace spidar
