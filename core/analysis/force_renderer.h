// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The second half of the analysis: from what moves in the frames to what is felt of it.
#pragma once

#include <memory>

#include "core/analysis/analyzer_settings.h"
#include "core/analysis/frame.h"
#include "core/choice/object_choice.h"
#include "core/force/gain_controller.h"
#include "core/force/motion_filter.h"
#include "core/force/wrench_fade.h"
#include "core/motion/cadence.h"

namespace spidar {

/// camera and objects → the motion that is felt → filter → gain controller → wrench.
class ForceRenderer {
 public:
  /// Throws std::invalid_argument when a setting is out of range, as configure() does.
  explicit ForceRenderer(const AnalyzerSettings& settings = {});

  /// See MotionAnalyzer::configure(); AnalyzerSettings::tracker does not matter here.
  void configure(const AnalyzerSettings& settings);

  /// Fills in what is felt of `frame`, and its wrench. Takes the frames in the order in which they
  /// are shown, but for those that wait.
  void render(Frame& frame, const FilmPlace& film = {});
  /// The next frame follows a seek or a discontinuity.
  void restart();

 private:
  Chosen choose(const Frame& frame, const FilmPlace& film);
  ImageMotion motion_of_choice(const Frame& frame, const FilmPlace& film,
                               const Chosen& choice) const;
  ImageMotion free_motion(const Frame& frame) const;

  AnalyzerSettings settings_;
  ObjectChoice choice_;
  LostFrames lost_frames_;
  MotionFilter filter_;
  WrenchFade fade_;
  std::unique_ptr<GainController> controller_;
};

}  // namespace spidar
