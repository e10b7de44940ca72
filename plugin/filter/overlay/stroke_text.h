// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Numbers as strokes, to be drawn into video of any format without a typeface.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace spidar {

struct TextStroke {
  Eigen::Vector2d from, to;
};

/// The strokes of a text with the characters 0 to 9, point, space and N, where 1 is the height of a
/// character and (0, 0) the upper left corner; others are spaces.
std::vector<TextStroke> strokes_of(const std::string& text);
/// Its width, in heights of a character.
double stroke_width_of(const std::string& text);

}  // namespace spidar
