// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A film as it might have been measured.
#pragma once

#include <cstdint>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "core/analysis/motion_codes.h"
#include "core/analysis/motion_file.h"

namespace spidar::test {

constexpr int64_t kMeasuredFrame_ns = 40'000'000;

struct MeasuredFilm {
  std::vector<MotionMoment> moments;
  std::vector<MeasuredFrame> frames;  ///< one for each moment

  std::string file(const MotionHeader& header = {}) const {
    MotionFileWriter writer;
    std::string bytes = write_header(header);
    for (size_t i = 0; i < frames.size(); ++i) writer.add(moments[i], frames[i], bytes);
    writer.finish(bytes);
    return bytes;
  }
};

inline MotionFile read_motion(const std::string& bytes) {
  std::istringstream stream(bytes);
  return MotionFile(stream);
}

/// Cuts, repeats, gaps and up to three objects that come and go, in every frame of a camera that
/// moves.
inline MeasuredFilm random_film(uint32_t seed, size_t count) {
  std::mt19937 random(seed);
  const auto uniform = [&](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
  };
  MeasuredFilm film;
  MeasuredFrame frame;
  for (size_t n = 0; n < count; ++n) {
    MotionMoment moment;
    moment.stream_ns = static_cast<int64_t>(n) * kMeasuredFrame_ns;
    moment.duration_ns = n % 5 == 0 ? -1 : kMeasuredFrame_ns;
    moment.turn = PictureTurn(static_cast<int>(n / 100 % 4), n / 400 % 2 == 1);
    const auto what = static_cast<uint32_t>(n == 0 ? 0 : random() % 40);
    moment.empty = what == 1;
    if (what == 2) moment.kind = MomentKind::kUnknown;
    if (what == 3) moment.kind = MomentKind::kNothing;
    frame.anew = n == 0;
    frame.shown = what == 0               ? Shown::kFirst
                  : what == 4             ? Shown::kSame
                  : what == 5             ? Shown::kAlike
                  : what > 5 && what < 10 ? Shown::kWaiting
                                          : Shown::kOther;
    if (frame.shown != Shown::kWaiting) {
      frame.width = 640;
      frame.height = 360;
      frame.features = static_cast<int>(random() % 500);
      frame.background.reset();
      frame.objects.clear();
      frame.votes = 0;
      frame.dominant = 0;
      frame.interval_ns = frame.shown_for_ns = 0;
    }
    if (frame.shown != Shown::kFirst && frame.shown != Shown::kWaiting) {
      frame.interval_ns = frame.shown_for_ns = kMeasuredFrame_ns;
      frame.votes = static_cast<int>(random() % 300);
      Background background;
      background.model.kind = ModelKind::kSimilarity;
      background.model.shift_px = {uniform(-5, 5), uniform(-5, 5)};
      background.model.linear << 0.01, -0.002, 0.002, 0.01;
      background.sigma_px = uniform(0, 1);
      background.coverage = uniform(0, 1);
      frame.background = background;
      for (uint32_t k = 0; k < (n / 50) % 4; ++k) {
        MovingObject object;
        object.id = static_cast<uint32_t>(n / 50) + k + 1;
        object.position_px = {uniform(-320, 320), uniform(-180, 180)};
        object.size_px = {uniform(10, 100), uniform(10, 100)};
        object.relative_px_s = {uniform(-500, 500), uniform(-500, 500)};
        object.growth_1_s = uniform(-1, 1);
        object.roll_rad_s = uniform(-1, 1);
        object.error_px_s = uniform(0, 10);
        object.area_px2 = uniform(64, 10000);
        object.prominence = uniform(0, 1);
        object.tracks = static_cast<int>(random() % 50);
        frame.objects.push_back(object);
        frame.dominant = object.id;
      }
      round_measured(frame);
    }
    film.moments.push_back(moment);
    film.frames.push_back(frame);
  }
  return film;
}

}  // namespace spidar::test
