// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/overlay/stroke_text.h"

#include <array>

namespace spidar {
namespace {

constexpr double kWide = 0.55, kNarrow = 0.1, kBetween = 0.25, kDot = 0.12;

double width_of(char letter) {
  return letter == '.' || letter == ' ' ? kNarrow : kWide;
}

/// The bars of a seven-segment display: top, the upper two, middle, the lower two, bottom. A bit
/// says whether a digit has the bar, the lowest one of 0.
const std::array<std::pair<TextStroke, unsigned>, 7> kBars{{
    {{{0, 0}, {kWide, 0}}, 0b1111101101},
    {{{0, 0}, {0, 0.5}}, 0b1101110001},
    {{{kWide, 0}, {kWide, 0.5}}, 0b1110011111},
    {{{0, 0.5}, {kWide, 0.5}}, 0b1101111100},
    {{{0, 0.5}, {0, 1}}, 0b0101000101},
    {{{kWide, 0.5}, {kWide, 1}}, 0b1111111011},
    {{{0, 1}, {kWide, 1}}, 0b1101101101},
}};

std::vector<TextStroke> strokes_of_letter(char letter) {
  if (letter == '.') return {{{kNarrow / 2, 1 - kDot}, {kNarrow / 2, 1}}};
  if (letter == 'N') return {{{0, 1}, {0, 0}}, {{0, 0}, {kWide, 1}}, {{kWide, 1}, {kWide, 0}}};
  std::vector<TextStroke> strokes;
  if (letter < '0' || letter > '9') return strokes;
  for (const auto& [bar, digits] : kBars) {
    if ((digits >> (letter - '0') & 1u) != 0) strokes.push_back(bar);
  }
  return strokes;
}

}  // namespace

std::vector<TextStroke> strokes_of(const std::string& text) {
  std::vector<TextStroke> strokes;
  Eigen::Vector2d at(0, 0);
  for (const char letter : text) {
    for (const TextStroke& stroke : strokes_of_letter(letter)) {
      strokes.push_back({at + stroke.from, at + stroke.to});
    }
    at.x() += width_of(letter) + kBetween;
  }
  return strokes;
}

double stroke_width_of(const std::string& text) {
  double width = 0;
  for (const char letter : text) width += width_of(letter) + kBetween;
  return text.empty() ? 0 : width - kBetween;
}

}  // namespace spidar
