// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Pictures of a relief, as data.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/touch/height_field.h"
#include "plugin/overlay/touch_view.h"
#include "plugin/window/still.h"
#include "plugin/window/window_model.h"

namespace spidar {

/// The relief as the viewer would see it in plain grey, lit from the upper left: a pixel a sample.
void shade_relief(const HeightField& relief, Still& picture);

/// Heights along the line through `y_m` from the left to the right edge: x and z, metres.
std::vector<Eigen::Vector2d> relief_section(const HeightField& relief, double y_m, int points);

/// How far the grip is in front of the surface, or how deep in it: "3.2 mm in front". Empty without
/// a relief.
std::string depth_line(const TouchScene& scene, const TickRecord& tick);

}  // namespace spidar
