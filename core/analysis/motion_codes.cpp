// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/analysis/motion_codes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Core>

namespace spidar {
namespace {

constexpr double kLargestHalf = 65504;
constexpr double kLengthSteps = 4096;

template <typename Code>
Code to_steps(double share) {
  using Limits = std::numeric_limits<Code>;
  if (!std::isfinite(share)) return 0;
  return static_cast<Code>(std::clamp(std::round(share * kLengthSteps),
                                      static_cast<double>(Limits::min()),
                                      static_cast<double>(Limits::max())));
}

}  // namespace

uint16_t to_half(double value) {
  if (std::isnan(value)) return 0;
  const double bounded = std::clamp(value, -kLargestHalf, kLargestHalf);
  return Eigen::numext::bit_cast<uint16_t>(Eigen::half(static_cast<float>(bounded)));
}

double from_half(uint16_t code) {
  const auto value =
      static_cast<double>(static_cast<float>(Eigen::numext::bit_cast<Eigen::half>(code)));
  return std::isfinite(value) ? value : 0;
}

double longer_side_px(const MeasuredFrame& frame) {
  return std::max(frame.width, frame.height);
}

ObjectCode encode_object(const MovingObject& object, double side_px) {
  ObjectCode code;
  code.id = object.id;
  code.x = to_steps<int16_t>(object.position_px.x() / side_px);
  code.y = to_steps<int16_t>(object.position_px.y() / side_px);
  code.width = to_steps<uint16_t>(object.size_px.x() / side_px);
  code.height = to_steps<uint16_t>(object.size_px.y() / side_px);
  code.velocity_x = to_half(object.relative_px_s.x() / side_px);
  code.velocity_y = to_half(object.relative_px_s.y() / side_px);
  code.growth = to_half(object.growth_1_s);
  code.roll = to_half(object.roll_rad_s);
  code.error = to_half(object.error_px_s / side_px);
  code.area = to_half(object.area_px2 / (side_px * side_px));
  code.prominence = to_half(object.prominence);
  code.tracks = static_cast<uint16_t>(std::clamp(object.tracks, 0, 65535));
  code.model = static_cast<uint8_t>(object.model);
  return code;
}

MovingObject decode_object(const ObjectCode& code, double side_px, const Background& background,
                           double interval_s) {
  MovingObject object;
  object.id = code.id;
  object.position_px = Eigen::Vector2d(code.x, code.y) / kLengthSteps * side_px;
  object.size_px = Eigen::Vector2d(code.width, code.height) / kLengthSteps * side_px;
  object.relative_px_s =
      Eigen::Vector2d(from_half(code.velocity_x), from_half(code.velocity_y)) * side_px;
  object.on_screen_px_s =
      object.relative_px_s + background.model.displacement_px(object.position_px) / interval_s;
  object.growth_1_s = from_half(code.growth);
  object.roll_rad_s = from_half(code.roll);
  object.error_px_s = from_half(code.error) * side_px;
  object.area_px2 = from_half(code.area) * side_px * side_px;
  object.prominence = from_half(code.prominence);
  object.tracks = code.tracks;
  object.model = static_cast<ModelKind>(code.model);
  return object;
}

BackgroundCode encode_background(const std::optional<Background>& background, double side_px) {
  BackgroundCode code;
  if (!background) return code;
  const MotionModel& model = background->model;
  code.model = static_cast<uint8_t>(1 + static_cast<int>(model.kind));
  code.shift_x = to_half(model.shift_px.x() / side_px);
  code.shift_y = to_half(model.shift_px.y() / side_px);
  code.linear_xx = to_half(model.linear(0, 0));
  code.linear_xy = to_half(model.linear(0, 1));
  code.linear_yx = to_half(model.linear(1, 0));
  code.linear_yy = to_half(model.linear(1, 1));
  code.perspective_x = to_half(model.perspective_1_px.x() * side_px);
  code.perspective_y = to_half(model.perspective_1_px.y() * side_px);
  code.sigma = to_half(background->sigma_px / side_px);
  code.coverage = to_half(background->coverage);
  return code;
}

std::optional<Background> decode_background(const BackgroundCode& code, double side_px) {
  if (code.model == 0) return std::nullopt;
  Background background;
  MotionModel& model = background.model;
  model.kind = static_cast<ModelKind>(code.model - 1);
  model.shift_px = Eigen::Vector2d(from_half(code.shift_x), from_half(code.shift_y)) * side_px;
  model.linear << from_half(code.linear_xx), from_half(code.linear_xy), from_half(code.linear_yx),
      from_half(code.linear_yy);
  model.perspective_1_px =
      Eigen::Vector2d(from_half(code.perspective_x), from_half(code.perspective_y)) / side_px;
  background.sigma_px = from_half(code.sigma) * side_px;
  background.coverage = from_half(code.coverage);
  return background;
}

void round_measured(MeasuredFrame& frame) {
  if (!frame.background) return;
  const double side_px = longer_side_px(frame);
  const double interval_s = static_cast<double>(frame.interval_ns) * 1e-9;
  frame.background = decode_background(encode_background(frame.background, side_px), side_px);
  for (MovingObject& object : frame.objects) {
    object = decode_object(encode_object(object, side_px), side_px, *frame.background, interval_s);
  }
}

}  // namespace spidar
