// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Films of a ball that circles, rotates and grows, and what the analysis finds.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/analysis/motion_analyzer.h"
#include "core/quantile.h"
#include "tests/support/moving_scene.h"

namespace spidar::test {

/// A film of 640 × 360 px, 8 s at 30 frames a second, with the noise of a sensor. Rotation and
/// growth swing; neither is known before the picture moves.
struct TurningBall {
  bool is_textured = false;  ///< otherwise a beach ball: six flat sectors
  double radius_px = 36;
  double turn_rad_s = 0;  ///< amplitude; the same for growth
  double growth_1_s = 0;
  bool in_hand = false;  ///< the camera

  static constexpr int kFrames = 240;
  static constexpr double kFrame_s = 1 / 30.0;
  static constexpr int kFirst = 8;  ///< frame in which an object is known, and felt in full

  std::string name() const {
    return std::string(is_textured ? "textured" : "beach") + " ball of " +
           std::to_string(static_cast<int>(radius_px)) + " px, " +
           (turn_rad_s > 0   ? growth_1_s > 0 ? "turns and grows" : "turns"
            : growth_1_s > 0 ? "grows"
                             : "goes round") +
           (in_hand ? ", in a hand" : "");
  }

  Placement ball(int n) const {
    const double t_s = n * kFrame_s;
    const double swing_s = (1 - std::cos(kSwings_rad_s * t_s)) / kSwings_rad_s;
    return {{110 * std::sin(kGoesRound_rad_s * t_s), 60 * std::cos(kGoesRound_rad_s * t_s)},
            std::exp(growth_1_s * (swing_s - 1 / kSwings_rad_s)),
            turn_rad_s * swing_s};
  }
  Placement background(int n) const {
    const double t_s = in_hand ? n * kFrame_s : 0;
    return {{5 * std::sin(6.9 * t_s) + 2 * std::sin(15.1 * t_s), 4 * std::sin(8.3 * t_s)},
            1,
            0.006 * std::sin(5.7 * t_s)};
  }
  /// Between this frame and the one before, relative to the background.
  double true_roll_rad_s(int n) const {
    return (ball(n).angle_rad - ball(n - 1).angle_rad - background(n).angle_rad +
            background(n - 1).angle_rad) /
           kFrame_s;
  }
  double true_growth_1_s(int n) const { return (ball(n).scale / ball(n - 1).scale - 1) / kFrame_s; }

  /// Calls `take(n, view)` for each frame.
  template <typename Take>
  void play(Take&& take) const {
    MovingScene scene(640, 360);
    if (is_textured) {
      scene.add_disc(radius_px);
    } else {
      scene.add_disc(radius_px, [](const Eigen::Vector2d& at_px) { return beach(at_px); });
    }
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, 1.5);
    std::array<int, 4096> grain;
    for (int& grey : grain) grey = static_cast<int>(std::lround(noise(random)));
    for (int n = 0; n < kFrames; ++n) {
      const ImageView clean = scene.draw(background(n), {ball(n)});
      std::vector<uint8_t> pixels(clean.data, clean.data + clean.stride_bytes * clean.height);
      for (uint8_t& pixel : pixels) {
        pixel = static_cast<uint8_t>(std::clamp(pixel + grain[random() % grain.size()], 0, 255));
      }
      take(n, ImageView{pixels.data(), clean.width, clean.height, clean.stride_bytes});
    }
  }

 private:
  static constexpr double kSwings_rad_s = 2 * M_PI / 1.6;
  static constexpr double kGoesRound_rad_s = 2 * M_PI / 4;

  static double beach(const Eigen::Vector2d& at_px) {
    constexpr std::array<double, 6> kGrey = {235, 90, 200, 60, 225, 120};
    const double turns = std::atan2(at_px.y(), at_px.x()) / (2 * M_PI) + 1;
    const double sector = std::fmod(6 * turns, 6);
    const auto here = static_cast<size_t>(sector) % 6;
    // The edge to the nearer one of the next sectors is one pixel soft.
    const double beyond = sector - std::floor(sector);
    const bool is_next = beyond > 0.5;
    const double from_edge_px = at_px.norm() * std::sin((is_next ? 1 - beyond : beyond) * M_PI / 3);
    const double other = kGrey[(here + (is_next ? 1 : 5)) % 6];
    return kGrey[here] + std::max(0.0, 0.5 - from_edge_px) * (other - kGrey[here]);
  }
};

/// The measured values of one axis over a film, beside the true ones.
struct FollowedAxis {
  std::vector<double> found, truth;

  void add(double of_frame, double of_truth) {
    found.push_back(of_frame);
    truth.push_back(of_truth);
  }
  /// How often the value changes between zero and others.
  int switches() const {
    int count = 0;
    for (size_t i = 1; i < found.size(); ++i) count += (found[i] == 0) != (found[i - 1] == 0);
    return count;
  }
  /// In 99 % of the frames, the error of the change since the previous frame is smaller.
  double jump() const {
    std::vector<double> jumps;
    for (size_t i = 1; i < found.size(); ++i) {
      jumps.push_back(std::abs(found[i] - found[i - 1] - truth[i] + truth[i - 1]));
    }
    return quantile(jumps, 0.99);
  }
  double error(double fraction) const {
    std::vector<double> errors;
    for (size_t i = 0; i < found.size(); ++i) errors.push_back(std::abs(found[i] - truth[i]));
    return quantile(errors, fraction);
  }
};

struct FollowedBall {
  FollowedAxis roll_rad_s, growth_1_s;
};

inline FollowedBall follow(const TurningBall& ball) {
  FollowedBall followed;
  MotionAnalyzer analyzer;
  ball.play([&](int n, const ImageView& view) {
    const Frame& frame = analyzer.analyze(view, std::llround(n * ball.kFrame_s * 1e9));
    if (n < ball.kFirst) return;
    followed.roll_rad_s.add(frame.motion.roll_rad_s, ball.true_roll_rad_s(n));
    followed.growth_1_s.add(frame.motion.growth_1_s, ball.true_growth_1_s(n));
  });
  return followed;
}

}  // namespace spidar::test
