// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/analysis/motion_analyzer.h"
#include "core/force/wrench_timeline.h"
#include "tests/support/picture.h"

namespace spidar::test {

/// A frame of a film that consists of several pictures: which picture it shows, and when.
struct ShownFrame {
  int64_t time_ns;
  const Picture* picture;
  bool flagged = false;  ///< marked as repeated, as by videorate, and not analysed
};

/// The force in each millisecond. A frame becomes known `ahead_ns` before it is shown.
inline std::vector<Eigen::Vector3d> feel(const std::vector<ShownFrame>& frames, int64_t ahead_ns,
                                         const AnalyzerSettings& settings = {}) {
  constexpr int64_t kTick_ns = 1'000'000;
  constexpr int64_t kLate_ns = 10'000'000;  // how late a live frame may be (FilmRenderer)
  MotionAnalyzer analyzer(settings);
  WrenchTimeline timeline;
  std::vector<Eigen::Vector3d> force_N;
  size_t next = 0;
  const int64_t end_ns = frames.back().time_ns;
  for (int64_t now_ns = 0; now_ns <= end_ns; now_ns += kTick_ns) {
    for (; next < frames.size() && frames[next].time_ns <= now_ns + ahead_ns; ++next) {
      const ShownFrame& frame = frames[next];
      Frame analysis;
      if (frame.flagged) {
        const Frame* const again = analyzer.repeat(frame.time_ns);
        analysis = again ? *again : Frame();
      } else {
        analysis = analyzer.analyze(frame.picture->view(), frame.time_ns);
      }
      const int64_t since_ns = next > 0 ? frame.time_ns - frames[next - 1].time_ns : 0;
      timeline.push({frame.time_ns, since_ns + kLate_ns, analysis.wrench,
                     analysis.is_continuation(), analysis.interval_ns / 2});
    }
    const TimelineResult result = timeline.at(now_ns);
    const bool felt = result.found != Found::kNothing && result.found != Found::kExpired;
    force_N.push_back(felt ? result.wrench.force_N : Eigen::Vector3d::Zero());
  }
  return force_N;
}

/// The difference of two curves of force, from the millisecond `from` on.
struct FeltDifference {
  double strength = 0;   ///< rms of the force, over that of the plain film
  double angle_rad = 0;  ///< between the two curves, as vectors
  double steps = 0;      ///< rms of the change in a millisecond, over that of the plain film
};

inline FeltDifference compare_felt(const std::vector<Eigen::Vector3d>& force_N,
                                   const std::vector<Eigen::Vector3d>& plain_N, size_t from) {
  double ff = 0, pp = 0, fp = 0, steps = 0, plain_steps = 0;
  const size_t end = std::min(force_N.size(), plain_N.size());
  for (size_t i = from; i < end; ++i) {
    ff += force_N[i].squaredNorm();
    pp += plain_N[i].squaredNorm();
    fp += force_N[i].dot(plain_N[i]);
    steps += (force_N[i] - force_N[i - 1]).squaredNorm();
    plain_steps += (plain_N[i] - plain_N[i - 1]).squaredNorm();
  }
  return {std::sqrt(ff / pp), std::acos(std::min(1.0, fp / std::sqrt(ff * pp))),
          std::sqrt(steps / plain_steps)};
}

}  // namespace spidar::test
