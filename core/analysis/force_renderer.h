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

/// Settings of the analysis of frames and of the rendering of forces.
struct AnalyzerSettings {
  TrackerSettings tracker;
  MotionKind motion = MotionKind::kObject;
  AreaSetting area;  ///< in px of the pictures
  /// The pointer of MotionKind::kObjects, as a position in the picture: (0, 0) is the top left
  /// corner, (1, 1) the bottom right one; finite.
  Eigen::Vector2d pointer{0.5, 0.5};
  /// Rules that replace `motion` while one of them holds; ignored with kMean, which has no objects.
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

/// Cross-fades wrenches: when the felt object changes or is lost, the last wrench fades out over
/// kFade_s while the new one fades in. If nothing was felt before, a new object is felt at once and
/// in full.
class WrenchFade {
 public:
  /// Begins a frame. `object` is a constant number for each thing that is felt; 0: nothing, or the
  /// whole picture. Returns whether the last wrench begins to fade out.
  bool set_object(uint64_t object);

  /// Returns the wrench to render in this frame, `interval_s` > 0 after the previous one. `wrench`
  /// is that of the object, without a fade.
  Wrench fade(const Wrench& wrench, double interval_s);

  /// Call this after a cut or a seek, and in a still picture: nothing fades.
  void reset() { *this = WrenchFade(); }

  /// Two or three frames of a film: shorter than the reaction time of a hand, about 0.15 s.
  static constexpr double kFade_s = 0.1;

 private:
  uint64_t object_ = 0;
  double old_fraction_ = 0;  ///< weight of `old_`; 0: no fade
  Wrench old_;
  Wrench felt_;  ///< the result of the last fade()
};

inline bool WrenchFade::set_object(uint64_t object) {
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

  /// Like MotionAnalyzer::configure(), but does not use AnalyzerSettings::tracker.
  void configure(const AnalyzerSettings& settings);

  /// Sets the felt motion and the wrench of `frame`. Call this in display order for each frame that
  /// does not wait. `settings` are those of configure(), `stream_ns` is the position in the film,
  /// and `turn` is how the frame is turned before display.
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
