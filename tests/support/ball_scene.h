// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "tests/support/moving_scene.h"

namespace spidar::test {

/// Lengths in pixels of the frame, image frame I: x right, y down, (0, 0) the centre of the first
/// pixel.
struct BallSettings {
  int width = 640;
  int height = 360;
  double radius_px = 40;
  Eigen::Vector2d start_px{320, 60};  ///< centre at t = 0, above the floor
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
  explicit BallScene(const BallSettings& settings = {})
      : settings_(settings), scene_(settings.width, settings.height, settings.seed) {
    if (!settings.textured_background) scene_.plain_background();
    scene_.add_disc(settings.radius_px);
  }

  const BallSettings& settings() const { return settings_; }

  /// Centre of the ball; `t_s` ≥ 0.
  Eigen::Vector2d position_px(double t_s) const {
    return {settings_.start_px.x() + settings_.horizontal_px_s * t_s,
            settings_.floor_px - settings_.radius_px - height_px(t_s)};
  }
  /// At an impact: the velocity after it.
  Eigen::Vector2d velocity_px_s(double t_s) const {
    const Flight flight = flight_at(t_s);
    const double down =
        flight.resting ? 0 : settings_.gravity_px_s2 * (t_s - flight.begin_s) - flight.up_px_s;
    return {settings_.horizontal_px_s, down};
  }
  /// Times of the impacts in [0, until_s].
  std::vector<double> impacts_s(double until_s) const {
    std::vector<double> impacts;
    double t_s = until_s;
    // Backwards in time: each flight but the first begins with an impact.
    for (Flight flight = flight_at(t_s); flight.begin_s > 0;) {
      impacts.push_back(flight.begin_s);
      t_s = std::nextafter(flight.begin_s, 0.0);
      flight = flight_at(t_s);
    }
    std::reverse(impacts.begin(), impacts.end());
    return impacts;
  }

  /// The frame at `t_s`, valid until the next call.
  ImageView draw(double t_s) {
    const Eigen::Vector2d middle_px(settings_.width - 1, settings_.height - 1);
    return scene_.draw({}, {{position_px(t_s) - middle_px / 2}});
  }

 private:
  /// A shorter flight counts as rest, because there are infinitely many of them.
  static constexpr double kRest_s = 1e-9;

  /// A part of the fall between two impacts.
  struct Flight {
    double begin_s;
    double height_px;  ///< above the floor at its begin
    double up_px_s;    ///< speed at its begin
    bool resting;
  };
  Flight flight_at(double t_s) const {
    const double g = settings_.gravity_px_s2;
    const double drop_px = settings_.floor_px - settings_.radius_px - settings_.start_px.y();
    double impact_s = std::sqrt(2 * drop_px / g);
    if (t_s < impact_s) return {0, drop_px, 0, false};
    double up_px_s = g * impact_s * settings_.restitution;
    while (2 * up_px_s / g > kRest_s) {
      const double next_s = impact_s + 2 * up_px_s / g;
      if (t_s < next_s) return {impact_s, 0, up_px_s, false};
      impact_s = next_s;
      up_px_s *= settings_.restitution;
    }
    return {impact_s, 0, 0, true};
  }
  double height_px(double t_s) const {
    const Flight flight = flight_at(t_s);
    if (flight.resting) return 0;
    const double s = t_s - flight.begin_s;
    return flight.height_px + flight.up_px_s * s - settings_.gravity_px_s2 * s * s / 2;
  }

  BallSettings settings_;
  MovingScene scene_;
};

}  // namespace spidar::test
