// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The measured motion of a film, to which several controllers can be applied.
#pragma once

#include <string>
#include <vector>

#include "core/analysis/motion_analyzer.h"

namespace spidar {

struct FilmFrame {
  /// Running time since the frame with which this one was compared; 0: a cut, or the first frame.
  double interval_s = 0;
  ImageMotion motion;  ///< not filtered
};

struct Film {
  std::string name;
  int height = 0;  ///< pixels
  std::vector<FilmFrame> frames;
};

/// Takes frames in the order in which they are shown.
class FilmRecorder {
 public:
  FilmRecorder(std::string name, const AnalyzerSettings& settings) : analyzer_(settings) {
    film_.name = std::move(name);
  }

  void add(const ImageView& frame, int64_t running_time_ns) {
    const FrameAnalysis analysis = analyzer_.analyze(frame, running_time_ns);
    film_.height = frame.height;
    film_.frames.push_back({static_cast<double>(analysis.interval_ns) * 1e-9, analysis.motion});
  }

  const Film& film() const { return film_; }

 private:
  MotionAnalyzer analyzer_;
  Film film_;
};

}  // namespace spidar
