// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>

#include "tests/support/spline_sheet.h"

namespace spidar::test {

/// Resembles a photograph for trackers: things of all sizes that hide each other, with edges, some
/// of them flat, some grained.
///
/// Dead leaves (Lee, Mumford, Huang: Occlusion models for natural images, Int. J. Computer Vision
/// 41, 2001): ellipses and rectangles whose number goes with radius⁻³, so that every octave covers
/// the same area, each with a grey level of its own. On most of them lies noise of the same
/// variance in every octave. Both have amplitude spectra of 1/f, as photographs have.
SplineSheet photo_sheet(uint32_t seed, double width_px, double height_px);

SplineSheet plain_sheet(double grey);

/// Dark on one side of a line through `through_px`, bright on the side to which `normal` points.
SplineSheet edge_sheet(double width_px, double height_px, const Eigen::Vector2d& through_px,
                       const Eigen::Vector2d& normal);

}  // namespace spidar::test
