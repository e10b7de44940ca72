// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Measurements in as few bits as they deserve.
#pragma once

#include <cstdint>
#include <optional>

#include "core/analysis/measured_frame.h"
#include "core/motion/background.h"
#include "core/motion/moving_object.h"

namespace spidar {

/// IEEE 754 binary16, rounded to nearest; what is larger than its largest number becomes that, and
/// what is not a number becomes 0. Its 11 bits are off by 0.05 % at most: the displacement of an
/// object by ten pixels is measured to one or two per cent, and a hand tells forces apart that
/// differ by 7 % (Jones 1989).
uint16_t to_half(double value);
double from_half(uint16_t code);

/// All lengths are shares of the longer side of the frame. Places and sizes are multiples of
/// 1/4096, all else is to_half().
struct ObjectCode {
  uint32_t id = 0;
  int16_t x = 0, y = 0;
  uint16_t width = 0, height = 0;
  uint16_t velocity_x = 0, velocity_y = 0;  ///< relative to the background
  uint16_t growth = 0, roll = 0, error = 0, area = 0, prominence = 0;
  uint16_t tracks = 0;
  uint8_t model = 0;  ///< ModelKind
};

struct BackgroundCode {
  uint8_t model = 0;  ///< 0: none, else 1 + ModelKind
  uint16_t shift_x = 0, shift_y = 0;
  uint16_t linear_xx = 0, linear_xy = 0, linear_yx = 0, linear_yy = 0;
  uint16_t perspective_x = 0, perspective_y = 0;
  uint16_t sigma = 0, coverage = 0;
};

/// The unit of lengths, px.
double longer_side_px(const MeasuredFrame& frame);

ObjectCode encode_object(const MovingObject& object, double side_px);
/// The velocity on the screen is the relative one plus that of the background at its middle, which
/// moves for `interval_s` > 0.
MovingObject decode_object(const ObjectCode& code, double side_px, const Background& background,
                           double interval_s);
BackgroundCode encode_background(const std::optional<Background>& background, double side_px);
std::optional<Background> decode_background(const BackgroundCode& code, double side_px);

/// What is left of `frame` when it has been encoded and decoded. The paper's mean stays as it is.
void round_measured(MeasuredFrame& frame);

}  // namespace spidar
