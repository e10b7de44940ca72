// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a film is felt like by what was measured of it before.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/analysis/frame_renderer.h"
#include "core/analysis/motion_file.h"
#include "core/picture_turn.h"

namespace spidar {

/// One thread at a time.
class MotionReplay {
 public:
  /// The film shows its pictures `later_ns` later than the file says. Null: there is none.
  void set_file(std::shared_ptr<const MotionFile> file, int64_t later_ns);
  bool active() const { return file_ != nullptr; }

  /// See FrameRenderer::configure(). The pointer is a place of the picture as it is shown.
  void configure(const AnalyzerSettings& settings);

  /// The frame of this stream time, which is played `rate` times as fast as it was measured,
  /// backwards when it is negative. Frames that were left out since the last call count, as long as
  /// they are kMostLeftOut at most; else the controller begins anew. Nothing when no such frame was
  /// measured.
  ///
  /// Which object a rule of AnalyzerSettings::feel is about is known wherever playback begins.
  std::optional<FrameAnalysis> at(int64_t stream_ns, double rate);

  /// Of the frame that at() was asked for last.
  const PictureTurn& turn() const { return turn_; }
  const MeasuredFrame& measured() const { return frame_; }

  /// Two seconds of an ordinary film.
  static constexpr size_t kMostLeftOut = 50;
  /// A frame is known by its time, which containers round to milliseconds.
  static constexpr int64_t kMostOff_ns = 10'000'000;

 private:
  std::optional<size_t> find(int64_t stream_ns) const;
  bool is_frame(size_t i) const { return file_->moment(i).kind == MomentKind::kFrame; }
  void begin();
  const FeelRule* rule_at(size_t i) const;
  void recall(size_t end);
  FilmPlace place_of(size_t i) const;
  void feed(size_t i, double rate);

  std::shared_ptr<const MotionFile> file_;
  int64_t later_ns_ = 0;
  std::vector<std::pair<int64_t, size_t>> by_time_;  ///< stream time and index of each frame
  AnalyzerSettings settings_;
  bool recalls_ = false;  ///< which objects were chosen has to be found out
  FrameRenderer renderer_;
  MeasuredFrame frame_;
  FrameAnalysis latest_;
  PictureTurn turn_;
  std::optional<size_t> last_;
};

}  // namespace spidar
