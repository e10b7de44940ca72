// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/program/hand.h"

#include <cmath>

namespace spidar {
namespace {

/// A finger over the ball from its root on the near side to its tip on the far side. `side`: its
/// place across the hand, −1 … 1; `reach`: how far around the ball it goes, radians.
HandStroke finger(double side, double reach) {
  constexpr double kOff = 1.06;  // of the ball's centre: half of it lies outside
  constexpr int kPoints = 7;
  HandStroke stroke;
  stroke.width = 0.34;
  for (int i = 0; i < kPoints; ++i) {
    const double turn = 0.5 + reach * i / (kPoints - 1);  // from the near side over the top
    const double across = 0.72 * side;
    const double radius = kOff * std::sqrt(std::max(1 - 0.5 * across * across, 0.0));
    stroke.points.emplace_back(across, radius * std::sin(turn), radius * std::cos(turn));
  }
  return stroke;
}

}  // namespace

const std::vector<HandStroke>& hand_strokes() {
  static const std::vector<HandStroke> strokes{
      {{{-0.75, -0.55, 0.95}, {-1.05, 0.05, 0.45}, {-0.95, 0.45, -0.1}}, 0.4, false},  // thumb
      {{{0.5, -2.5, 3.6}, {0.3, -1.2, 2.1}, {0.1, -0.35, 1.25}}, 0.85, true},          // forearm
      {{{-0.55, -0.2, 1.25}, {0.0, 0.1, 1.3}, {0.5, -0.05, 1.2}, {0.2, -0.45, 1.3}}, 0.8, true},
      finger(0.95, 1.35),
      finger(0.35, 1.75),
      finger(-0.25, 1.8),
      finger(-0.85, 1.55),
  };
  return strokes;
}

}  // namespace spidar
