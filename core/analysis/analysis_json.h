// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Writes the result of a frame's analysis as JSON.
#pragma once

#include <string>

#include "core/analysis/frame.h"

namespace spidar {

/// One JSON object and a line end. Keys carry their units; positions are pixels from the centre of
/// the frame, x right, y down:
///
///     running_time_ns, stream_time_ns, interval_ns, width_px, height_px, restarted, repeated,
///     features, object, motion: {velocity_px_s: [x, y], growth_1_s, roll_rad_s, tracked},
///     wrench: {force_N: [x, y, z], torque_Nm: [x, y, z]},
///     background: {model, shift_px, linear: [[xx, xy], [yx, yy]], perspective_1_px, sigma_px,
///                  coverage} or null,
///     objects: [{id, position_px, size_px, velocity_px_s, error_px_s, on_screen_px_s, growth_1_s,
///                roll_rad_s, model, points, prominence}, …]
///
/// (see ImageMotion, MotionModel and MovingObject; an object's velocity is against the background).
/// `repeated`: the frame shows the previous picture again, and all other values are those of that
/// picture. Numbers have as few digits as can be read back exactly. A number that is not finite
/// becomes null, because JSON cannot express it.
std::string json_line(const Frame& frame);

}  // namespace spidar
