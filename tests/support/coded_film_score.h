// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <vector>

#include "core/analysis/motion_analyzer.h"
#include "tests/support/coded_film.h"

namespace spidar::test {

/// In how many pictures of a CodedFilm the analysis is right, from kFirst on.
struct CodedFilmScore {
  static constexpr int kFirst = CodedFilm::kRests + 4;  ///< by then, something has moved
  int pictures = 0;
  /// Its motion is right to half a pixel, the precision of a search by whole pixels.
  int camera = 0;
  int felt = 0;  ///< right to half of the true motion; less than 0.1 px if no object moves
};

inline CodedFilmScore score(const CodedFilm& film, const std::vector<Picture>& pictures) {
  constexpr int64_t kPicture_ns = 40'000'000;
  MotionAnalyzer analyzer;
  CodedFilmScore score;
  for (int n = 0; n < CodedFilm::kPictures; ++n) {
    const Frame& frame = analyzer.analyze(pictures[static_cast<size_t>(n)].view(), n * kPicture_ns);
    if (n < CodedFilmScore::kFirst) continue;
    const Eigen::Vector2d camera_px = frame.background->model.shift_px;
    const Eigen::Vector2d felt_px = 1e-9 * kPicture_ns * frame.motion.velocity_px_s;
    Eigen::Vector2d true_px(0, 0);
    if (film.side_px > 0) true_px = film.square_moved_px(n) - film.wall_moved_px(n);
    ++score.pictures;
    score.camera += (camera_px - film.wall_moved_px(n)).norm() < 0.5;
    score.felt += (felt_px - true_px).norm() < (true_px.isZero() ? 0.1 : true_px.norm() / 2);
  }
  return score;
}

}  // namespace spidar::test
