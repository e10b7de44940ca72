// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/support/ball_scene.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace spidar::test {
namespace {

/// A shorter flight counts as rest, because there are infinitely many of them.
constexpr double kRest_s = 1e-9;
constexpr double kPlainGrey = 128;

/// The grid of the textures: structures of a few pixels in a picture reduced to 480 px.
double cell_px(const BallSettings& settings) {
  return settings.height / 45.0;
}

void require(bool right, const char* rule) {
  if (!right) throw std::invalid_argument(std::string("BallSettings: ") + rule);
}

}  // namespace

BallScene::BallScene(const BallSettings& settings)
    : settings_(settings), ball_(settings.seed, cell_px(settings)) {
  require(settings.width > 0 && settings.height > 0, "width and height must be positive");
  require(settings.radius_px > 0, "radius_px must be positive");
  require(settings.gravity_px_s2 > 0, "gravity_px_s2 must be positive");
  require(settings.restitution >= 0 && settings.restitution <= 1, "restitution must be 0 to 1");
  require(settings.start_px.y() + settings.radius_px <= settings.floor_px,
          "the ball must start above floor_px");

  const Texture texture(settings.seed + 1, cell_px(settings));
  background_.reserve(static_cast<size_t>(settings.width) * static_cast<size_t>(settings.height));
  for (int y = 0; y < settings.height; ++y) {
    for (int x = 0; x < settings.width; ++x) {
      background_.push_back(settings.textured_background ? texture.at(x, y) : kPlainGrey);
    }
  }
}

BallScene::Flight BallScene::flight_at(double t_s) const {
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

double BallScene::height_px(double t_s) const {
  const Flight flight = flight_at(t_s);
  if (flight.resting) return 0;
  const double s = t_s - flight.begin_s;
  return flight.height_px + flight.up_px_s * s - settings_.gravity_px_s2 * s * s / 2;
}

Eigen::Vector2d BallScene::position_px(double t_s) const {
  return {settings_.start_px.x() + settings_.horizontal_px_s * t_s,
          settings_.floor_px - settings_.radius_px - height_px(t_s)};
}

Eigen::Vector2d BallScene::velocity_px_s(double t_s) const {
  const Flight flight = flight_at(t_s);
  const double down =
      flight.resting ? 0 : settings_.gravity_px_s2 * (t_s - flight.begin_s) - flight.up_px_s;
  return {settings_.horizontal_px_s, down};
}

Eigen::Vector2d BallScene::acceleration_px_s2(double t_s) const {
  return {0, flight_at(t_s).resting ? 0 : settings_.gravity_px_s2};
}

std::vector<double> BallScene::impacts_s(double until_s) const {
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

void BallScene::render(double t_s, uint8_t* data, ptrdiff_t stride_bytes) const {
  const Eigen::Vector2d centre = position_px(t_s);
  const double reach = settings_.radius_px + 1;
  const double* background = background_.data();
  for (int y = 0; y < settings_.height; ++y, data += stride_bytes, background += settings_.width) {
    std::transform(background, background + settings_.width, data,
                   [](double grey) { return static_cast<uint8_t>(std::lround(grey)); });
    const double dy = y - centre.y();
    if (std::abs(dy) > reach) continue;
    const int first = std::max(0, static_cast<int>(std::floor(centre.x() - reach)));
    const int last = std::min(settings_.width - 1, static_cast<int>(std::ceil(centre.x() + reach)));
    for (int x = first; x <= last; ++x) {
      const double dx = x - centre.x();
      // The fraction of the pixel that the disc covers, with its edge taken as straight.
      const double cover =
          std::min(1.0, std::max(0.0, settings_.radius_px - std::hypot(dx, dy) + 0.5));
      if (cover == 0) continue;
      const double grey = cover * ball_.at(dx, dy) + (1 - cover) * background[x];
      data[x] = static_cast<uint8_t>(std::lround(grey));
    }
  }
}

}  // namespace spidar::test
