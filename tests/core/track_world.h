/// Tracks of a background and of things that move in front of it.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/motion/objects.h"
#include "track_samples.h"

namespace spidar::test {

/// Something with a fixed set of tracks that moves on its own.
struct Thing {
  Eigen::Vector2d middle_px{0, 0};
  Eigen::Vector2d moved_px{0, 0};  ///< a frame, on the screen
  double turn_rad = 0;             ///< a frame
  double grow = 0;                 ///< a frame
  bool hidden = false;
  uint32_t first_id = 0;
  std::vector<Eigen::Vector2d> spots_px;  ///< about the middle

  Thing(TrackSource& source, int tracks, double radius_px, uint32_t first) : first_id(first) {
    while (static_cast<int>(spots_px.size()) < tracks) {
      const double x = source.uniform(-radius_px, radius_px);
      const Eigen::Vector2d spot(x, source.uniform(-radius_px, radius_px));
      if (spot.norm() < radius_px) spots_px.push_back(spot);
    }
  }

  /// Moves it by a frame and adds its tracks.
  void step(TrackSource& source, std::vector<Displacement>& points, double sigma_px) {
    Eigen::Matrix2d change;
    change << std::cos(turn_rad), -std::sin(turn_rad), std::sin(turn_rad), std::cos(turn_rad);
    change *= 1 + grow;
    for (size_t i = 0; i < spots_px.size(); ++i) {
      const Eigen::Vector2d from = middle_px + spots_px[i];
      spots_px[i] = change * spots_px[i];
      const Eigen::Vector2d to = middle_px + moved_px + spots_px[i];
      if (hidden) continue;
      const auto id = first_id + static_cast<uint32_t>(i);
      points.push_back({id, from, to - from + source.noise_px(sigma_px)});
    }
    middle_px += moved_px;
  }
};

/// A world of a background and things, and what is found in it.
struct World {
  static constexpr int kWidth = 640;
  static constexpr int kHeight = 360;
  static constexpr double kFrame_s = 0.04;
  static constexpr double kSigma_px = 0.1;

  explicit World(uint32_t seed) : source(seed) {
    for (int i = 0; i < 150; ++i) spots_px.push_back(source.place_px());
  }

  const std::vector<MovingObject>& step() {
    std::vector<Displacement> points;
    // Always the same tracks, as those of a real background, so that noise, too, has ids that last.
    for (uint32_t id = 0; textured && id < spots_px.size(); ++id) {
      points.push_back(source.moved(camera, spots_px[id], noise_px));
      points.back().id = id;
    }
    for (Thing& thing : things) thing.step(source, points, noise_px);
    const Background& found = background.estimate(points, kWidth, kHeight);
    return objects.update(points, found, kWidth, kHeight, kFrame_s);
  }

  TrackSource source;
  std::vector<Eigen::Vector2d> spots_px;
  MotionModel camera;
  double noise_px = kSigma_px;
  bool textured = true;
  std::vector<Thing> things;
  BackgroundEstimator background;
  ObjectTracker objects;
};

}  // namespace spidar::test
