// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a debug window says of its data.
#pragma once

#include <string>
#include <vector>

#include "plugin/window/view/window_view.h"

namespace spidar {

class Timeline;

/// "1 object", "2 objects".
std::string count_of(size_t count, const std::string& noun);

/// Ids of the objects in sight whose motion is felt.
std::vector<uint32_t> felt_objects(const FrameFacts& facts);

/// "felt", or "not felt: " and why, for the last line of the window. While the surface is felt also
/// that the device gets less stiffness than is set.
std::string felt_line(const ElementState& state, const TouchScene& touch = {});

/// Force in N at `points` speeds from 0 to `highest_px_s`, of a controller that has learnt from
/// this timeline: the linear one all there is to know, the adaptive one what the plots show.
/// Empty when the settings are out of range.
std::vector<double> gain_curve(const ControllerSettings& settings, const Timeline& timeline,
                               double highest_px_s, int points);

}  // namespace spidar
