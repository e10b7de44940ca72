// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The second half of the analysis: from what moves in the frames to what is felt of it.
#pragma once

#include <memory>

#include "core/analysis/analyzer_settings.h"
#include "core/analysis/frame_analysis.h"
#include "core/analysis/measured_frame.h"
#include "core/choice/object_choice.h"
#include "core/force/gain_controller.h"
#include "core/force/motion_filter.h"
#include "core/force/wrench_fade.h"
#include "core/motion/cadence.h"

namespace spidar {

/// camera and objects → the motion that is felt → filter → gain controller → wrench.
class FrameRenderer {
 public:
  /// Throws std::invalid_argument when a setting is out of range, as configure() does.
  explicit FrameRenderer(const AnalyzerSettings& settings = {});

  /// See MotionAnalyzer::configure(); AnalyzerSettings::tracker does not matter here.
  void configure(const AnalyzerSettings& settings);

  /// Takes the frames in the order in which they are shown. The result points into `frame`, and
  /// that of a frame that waits into the last one that did not.
  FrameAnalysis render(const MeasuredFrame& frame, const FilmPlace& film = {});

 private:
  Chosen choose(const MeasuredFrame& frame, const FilmPlace& film);
  ImageMotion motion_of_choice(const MeasuredFrame& frame, const FilmPlace& film,
                               const Chosen& choice) const;
  ImageMotion free_motion(const MeasuredFrame& frame) const;
  FrameAnalysis wait() const;

  AnalyzerSettings settings_;
  ObjectChoice choice_;
  LostFrames lost_frames_;
  MotionFilter filter_;
  WrenchFade fade_;
  std::unique_ptr<GainController> controller_;
  FrameAnalysis latest_;  ///< of the last frame that did not wait
};

}  // namespace spidar
