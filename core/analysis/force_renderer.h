// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>

#include <Eigen/Core>

#include "core/analysis/frame.h"
#include "core/choice/object_choice.h"
#include "core/force/gain_controller.h"
#include "core/force/motion_filter.h"
#include "core/force/motion_rendering.h"
#include "core/force/washout.h"
#include "core/motion/image_motion.h"
#include "core/motion/lost_frames.h"
#include "core/picture/film_area.h"
#include "core/points/tracker.h"
#include "core/wrench.h"

namespace spidar {

/// Settings of the analysis of frames, and of the rendering of what it finds.
struct AnalyzerSettings {
  TrackerSettings tracker;
  MotionKind motion = MotionKind::kObject;
  AreaSetting area;  ///< in px of the pictures
  /// The position in the picture where kObjects is felt: (0, 0) is the top left corner, (1, 1) the
  /// bottom right one; finite.
  Eigen::Vector2d pointer{0.5, 0.5};
  /// Rules that replace `motion` while one holds, except kMean, which knows no objects.
  std::shared_ptr<const FeelRules> feel;
  KeptObject kept;  ///< has priority over `feel`
  /// The boxes of this frame; null: none.
  std::shared_ptr<const std::vector<PictureBox>> boxes;
  FilterSettings filter;
  AxisGains axes;
  ControllerSettings controller;
  double washout_Hz = 0;  ///< cut-off of Washout, finite and ≥ 0; 0: none
};

/// Closest to the paper: unfiltered mean velocity of OpenCvTracker's points, nonlinear controller.
AnalyzerSettings paper_settings();

/// Throws std::invalid_argument when a setting is out of range.
void validate(const AnalyzerSettings& settings);

/// When another object is felt than before, or none any more, the last wrench fades out over
/// kFade_s while the new one fades in. An object that begins to move while nothing is felt is felt
/// at once and in full.
class WrenchFade {
 public:
  /// Begins a frame. `object` identifies what is felt by a constant number; 0: nothing, or the
  /// whole picture. Returns whether the last wrench begins to fade out.
  bool turn_to(uint64_t object);

  /// The wrench to render in this frame, `interval_s` > 0 after the previous one, if `wrench` is
  /// that of the object.
  Wrench fade(const Wrench& wrench, double interval_s);

  /// Call this after a cut or a seek, and in a still picture: nothing fades.
  void reset() { *this = WrenchFade(); }

  /// Two or three frames of a film; shorter than the 0.15 s or so that a hand needs to react.
  static constexpr double kFade_s = 0.1;

 private:
  uint64_t object_ = 0;
  double old_fraction_ = 0;  ///< of `old_`; 0: nothing fades
  Wrench old_;
  Wrench felt_;  ///< in the last frame
};

inline bool WrenchFade::turn_to(uint64_t object) {
  const bool begins = object != object_ && object_ != 0;
  object_ = object;
  if (!begins) return false;
  old_ = felt_;
  old_fraction_ = 1;
  return true;
}

inline Wrench WrenchFade::fade(const Wrench& wrench, double interval_s) {
  old_fraction_ = std::max(0.0, old_fraction_ - interval_s / kFade_s);
  felt_ = old_fraction_ > 0 ? interpolate(wrench, old_, old_fraction_) : wrench;
  return felt_;
}

/// The second half of the analysis: camera and objects → the motion that is felt → filter → gain
/// controller → washout → wrench.
class ForceRenderer {
 public:
  /// Throws std::invalid_argument when a setting is out of range, as configure() does.
  explicit ForceRenderer(const AnalyzerSettings& settings);

  /// See MotionAnalyzer::configure(), but without AnalyzerSettings::tracker.
  void configure(const AnalyzerSettings& settings);

  /// Fills in what is felt of `frame`, and its wrench. Takes the frames in the order of display,
  /// except those that wait, with the `settings` of configure(), the position in the film, and the
  /// turn before display.
  void render(Frame& frame, const AnalyzerSettings& settings, int64_t stream_ns,
              const Orientation& turn);
  void reset();

 private:
  ObjectChoice choice_;
  LostFrames lost_frames_;
  MotionFilter filter_;
  Washout washout_;
  WrenchFade fade_;
  GainController controller_;
};

}  // namespace spidar
