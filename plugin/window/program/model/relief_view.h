// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Views of a relief, as data.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/touch/height_field.h"
#include "plugin/filter/frame/touch_view.h"
#include "plugin/window/view/window_view.h"

namespace spidar {

/// Renders the relief as a grey surface lit from the upper left: RGBA, one pixel per
/// sample, without padding.
std::vector<uint8_t> shade_relief(const HeightField& relief);

/// Cross-section at `y_m` from the left to the right edge: x and z in metres.
std::vector<Eigen::Vector2d> relief_section(const HeightField& relief, double y_m, int points);

/// The surface that this tick touches, or is in front of: the cross-section through the touched
/// point, as high as it is there. Between two frames, and while it rises, the surface is not where
/// the relief of a frame has it.
std::vector<Eigen::Vector2d> touched_section(const HeightField& relief, const TickRecord& tick,
                                             int points);

/// Distance of the grip in front of the surface or its depth below it, e.g. "3.2 mm in front".
/// Empty without contact and relief.
std::string depth_line(const TouchScene& scene, const TickRecord& tick);

}  // namespace spidar
