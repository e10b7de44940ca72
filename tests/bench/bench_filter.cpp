// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Trade-off of the 1 € filter between the delay of fast motion and the jitter of slow motion.
// Motion is measured from rendered, noisy pictures as the element does, and then filtered with
// several settings.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <random>
#include <vector>

#include "core/analysis/motion_analyzer.h"
#include "tests/support/ball_scene.h"
#include "tests/support/moving_scene.h"

namespace {

using spidar::FilterSettings;
using spidar::ImageMotion;

constexpr int kWidth = 640;
constexpr int kHeight = 480;  // the reference frame: px/s need no scale
constexpr double kNoise = 2;  // grey levels, as of a camera indoors

/// A path of something, and its motion as it was measured frame by frame.
struct Clip {
  const char* name;
  double interval_s;
  std::function<Eigen::Vector2d(double)> position_px;
  std::vector<double> time_s;
  std::vector<ImageMotion> motion;

  /// Mean velocity over the frame interval that ends at `time_s`: what a frame can show.
  Eigen::Vector2d shown_px_s(double time) const {
    return (position_px(time) - position_px(time - interval_s)) / interval_s;
  }
};

class Noise {
 public:
  void add(std::vector<uint8_t>& pixels) {
    for (uint8_t& pixel : pixels) {
      const double grey = pixel + noise_(random_);
      pixel = static_cast<uint8_t>(std::lround(std::clamp(grey, 0.0, 255.0)));
    }
  }

 private:
  std::mt19937 random_{1};
  std::normal_distribution<double> noise_{0, kNoise};
};

/// `render(t, pixels)` draws the frame of that time.
template <typename Render>
void measure(Clip& clip, double duration_s, Render&& render) {
  spidar::MotionAnalyzer analyzer;
  Noise noise;
  std::vector<uint8_t> pixels(kWidth * kHeight);
  for (int n = 0; n * clip.interval_s < duration_s; ++n) {
    const double time_s = n * clip.interval_s;
    render(time_s, pixels);
    noise.add(pixels);
    const auto frame =
        analyzer.analyze({pixels.data(), kWidth, kHeight, kWidth}, std::llround(1e9 * time_s));
    if (frame.motion.tracked == 0) continue;
    clip.time_s.push_back(time_s);
    clip.motion.push_back(frame.motion);
  }
}

Clip disc(const char* name, double rate_Hz, std::function<Eigen::Vector2d(double)> position_px) {
  Clip clip{name, 1 / rate_Hz, std::move(position_px), {}, {}};
  spidar::test::MovingScene scene(kWidth, kHeight);
  scene.add_disc(60);
  measure(clip, 6, [&](double time_s, std::vector<uint8_t>& pixels) {
    const spidar::ImageView view = scene.draw({}, {{clip.position_px(time_s)}});
    pixels.assign(view.data, view.data + pixels.size());
  });
  return clip;
}

Clip ball(const char* name, double rate_Hz) {
  spidar::test::BallSettings settings;
  settings.width = kWidth;
  settings.height = kHeight;
  settings.floor_px = 460;
  const spidar::test::BallScene scene(settings);
  const auto position_px = [scene](double time_s) {
    return scene.position_px(std::max(time_s, 0.0));
  };
  Clip clip{name, 1 / rate_Hz, position_px, {}, {}};
  measure(clip, 4, [&](double time_s, std::vector<uint8_t>& pixels) {
    scene.render(time_s, pixels.data(), kWidth);
  });
  return clip;
}

std::vector<Eigen::Vector2d> filtered(const Clip& clip, const FilterSettings& settings) {
  spidar::MotionFilter filter;
  std::vector<Eigen::Vector2d> velocities;
  double last_s = clip.time_s.front() - clip.interval_s;
  for (size_t i = 0; i < clip.motion.size(); ++i) {
    const double interval_s = clip.time_s[i] - last_s;
    last_s = clip.time_s[i];
    velocities.push_back(
        filter.filter(clip.motion[i], kHeight, interval_s, settings).velocity_px_s);
  }
  return velocities;
}

double rms_error(const Clip& clip, const std::vector<Eigen::Vector2d>& found, double delay_s) {
  double sum = 0;
  for (size_t i = 0; i < found.size(); ++i) {
    sum += (found[i] - clip.shown_px_s(clip.time_s[i] - delay_s)).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(found.size()));
}

/// The delay with which what was found fits best to what is shown.
double delay_s(const Clip& clip, const std::vector<Eigen::Vector2d>& found) {
  double best_s = 0;
  double least = 1e300;
  for (double delay = -0.02; delay < 0.4; delay += 0.0005) {
    const double error = rms_error(clip, found, delay);
    if (error < least) {
      least = error;
      best_s = delay;
    }
  }
  return best_s;
}

/// Change from frame to frame of what should be steady, rms.
double jitter_px_s(const std::vector<Eigen::Vector2d>& found) {
  double sum = 0;
  for (size_t i = 1; i < found.size(); ++i) sum += (found[i] - found[i - 1]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(found.size() - 1));
}

}  // namespace

int main() {
  const Clip crawl = disc("crawl", 25, [](double t) { return Eigen::Vector2d(-90 + 30 * t, 0); });
  const Clip slow = disc("slow sway", 25, [](double t) {
    return Eigen::Vector2d(30 * std::sin(2 * M_PI * 0.4 * t), 0);
  });
  const Clip sway = disc(
      "sway", 25, [](double t) { return Eigen::Vector2d(120 * std::sin(2 * M_PI * 0.8 * t), 0); });
  const Clip falls = ball("ball", 30);

  std::printf(
      "jitter from frame to frame: 30 px/s, steady. delay: sway of up to 75 px/s at 0.4 Hz, 600 "
      "px/s at 0.8 Hz,\n"
      "and a ball; error: rms of the ball's velocity, and of the slow sway's.\n\n");
  std::printf(
      "| min-cutoff, Hz | beta, s/px | jitter, px/s | delay slow | sway | ball, ms | "
      "error slow | ball, px/s |\n|---|---|---|---|---|---|---|---|\n");
  for (const FilterSettings settings : {FilterSettings{0, 0},
                                        {1, 0},
                                        {1, 0.01},
                                        {1, 0.03},
                                        {1, 0.08},
                                        {1, 0.2},
                                        {2, 0},
                                        {2, 0.01},
                                        {2, 0.03},
                                        {2, 0.08},
                                        {2, 0.2},
                                        {4, 0},
                                        {4, 0.01},
                                        {4, 0.03},
                                        {4, 0.08},
                                        {4, 0.2}}) {
    const auto slow_found = filtered(slow, settings);
    const auto sway_found = filtered(sway, settings);
    const auto ball_found = filtered(falls, settings);
    std::printf("| %g | %g | %.2f | %.0f | %.0f | %.0f | %.1f | %.0f |\n", settings.min_cutoff_Hz,
                settings.beta_s_px, jitter_px_s(filtered(crawl, settings)),
                1e3 * delay_s(slow, slow_found), 1e3 * delay_s(sway, sway_found),
                1e3 * delay_s(falls, ball_found), rms_error(slow, slow_found, 0),
                rms_error(falls, ball_found, 0));
  }
}
