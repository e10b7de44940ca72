// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "tests/support/texture.h"

namespace spidar::test {

/// Lengths in pixels of the frame, image frame I: x right, y down, (0, 0) the centre of the first
/// pixel.
struct BallSettings {
  int width = 640;
  int height = 360;
  double radius_px = 40;
  Eigen::Vector2d start_px{320, 60};  ///< centre at t = 0
  double horizontal_px_s = 0;         ///< constant, to the right
  double floor_px = 340;              ///< where the lower edge of the ball bounces
  double gravity_px_s2 = 1500;        ///< > 0, downwards
  double restitution = 0.85;          ///< speed after / before an impact, 0 … 1
  bool textured_background = false;   ///< false: plain grey
  uint32_t seed = 1;                  ///< of the textures
};

/// A bouncing ball whose motion is known exactly: the paper's Fig. 6. The ball falls from rest,
/// loses a part of its speed at each impact, and comes to rest on the floor when the impacts have
/// become infinitely short.
class BallScene {
 public:
  /// Throws std::invalid_argument when the ball does not start above the floor or a value is out of
  /// range.
  explicit BallScene(const BallSettings& settings = {});

  const BallSettings& settings() const { return settings_; }

  /// Centre of the ball; `t_s` ≥ 0.
  Eigen::Vector2d position_px(double t_s) const;
  /// At an impact: the velocity after it.
  Eigen::Vector2d velocity_px_s(double t_s) const;
  /// Gravity during a flight, 0 at rest; without the impulse of an impact.
  Eigen::Vector2d acceleration_px_s2(double t_s) const;
  /// Times of the impacts in [0, until_s].
  std::vector<double> impacts_s(double until_s) const;

  /// Draws the frame at `t_s`: `settings().height` rows of `width` bytes, `stride_bytes` apart. The
  /// ball carries its texture along, exact to any part of a pixel; its edge is one pixel soft.
  void render(double t_s, uint8_t* data, ptrdiff_t stride_bytes) const;

 private:
  /// A part of the fall between two impacts.
  struct Flight {
    double begin_s;
    double height_px;  ///< above the floor at its begin
    double up_px_s;    ///< speed at its begin
    bool resting;
  };
  Flight flight_at(double t_s) const;
  double height_px(double t_s) const;

  BallSettings settings_;
  Texture ball_;
  std::vector<double> background_;  ///< grey levels by rows
};

}  // namespace spidar::test
