// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>

#include "core/analysis/motion_analyzer.h"
#include "tests/support/depth_clip.h"

namespace spidar::test {

struct DepthClipScore {
  int pictures = 0;
  int felt = 0;

  void operator+=(const DepthClipScore& other) {
    pictures += other.pictures;
    felt += other.felt;
  }
};

/// In how many pictures something is felt though only the camera moves, from the third picture on,
/// with the lowest speed that tests/bench/real_films.py calls felt.
inline DepthClipScore score(const DepthClip& clip) {
  constexpr int64_t kPicture_ns = 40'000'000;
  constexpr int kFirst = 2;
  constexpr double kFelt_px_s = 2.1 * DepthClip::kHeight / kReferenceHeight_px;
  MotionAnalyzer analyzer;
  DepthClipScore score;
  for (int n = 0; n < DepthClip::kPictures; ++n) {
    const Picture picture = clip.picture(n);
    const Frame& frame = analyzer.analyze(picture.view(), n * kPicture_ns);
    if (n < kFirst) continue;
    ++score.pictures;
    score.felt += frame.motion.velocity_px_s.norm() > kFelt_px_s;
  }
  return score;
}

/// The sum over this number of clips.
inline DepthClipScore score(DepthClip::Kind kind, int clips) {
  DepthClipScore sum;
  for (int i = 0; i < clips; ++i) {
    sum += score(DepthClip(kind, static_cast<uint32_t>(1 + i + 100 * static_cast<int>(kind))));
  }
  return sum;
}
/// The number of clips of each kind for the benchmarks: 252 in all.
constexpr int kDepthClips = 36;

}  // namespace spidar::test
