// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The analysis of a frame, from picture to wrench.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/force/gain_controller.h"
#include "core/force/motion_filter.h"
#include "core/force/motion_rendering.h"
#include "core/image_view.h"
#include "core/motion/image_motion.h"
#include "core/motion/scene_motion.h"
#include "core/tracking/tracker.h"
#include "core/wrench.h"

namespace spidar {

struct AnalyzerSettings {
  TrackerSettings tracker;
  MotionKind motion = MotionKind::kObject;
  /// Place of the picture where kObjects is felt: (0, 0) is its top left corner, (1, 1) its bottom
  /// right one; finite.
  Eigen::Vector2d pointer{0.5, 0.5};
  FilterSettings filter;
  AxisGains axes;
  ControllerSettings controller;
};

/// Closest to the paper: mean velocity of the points of OpenCvTracker, unfiltered, nonlinear
/// controller.
AnalyzerSettings paper_settings();

/// The result of one frame.
struct FrameAnalysis {
  int width = 0;  ///< of the frame, px
  int height = 0;
  int features = 0;    ///< points looked for in the next frame
  ImageMotion motion;  ///< the one that is felt, unfiltered, in px/s of the frame as given
  /// Model of the background; nothing when `motion` needs none, and after a restart.
  std::optional<ModelKind> model;
  int objects = 0;         ///< how many are known; 0 when `motion` needs none
  Wrench wrench;           ///< wanted by the controller, before any safety limit
  bool restarted = false;  ///< there was nothing to compare with: motion and wrench are zero
  /// The frame shows the previous picture again, and the motion may go on: motion and wrench are
  /// those of the previous frame.
  bool repeated = false;
  /// Whether the frame shows the previous picture again, be it waiting (`repeated`) or at rest: the
  /// same pixels, or the same apart from the noise of coding.
  bool same_picture = false;
  /// The time in which the motion happened, see Cadence: it may span more than two frames; 0 after
  /// a restart.
  int64_t interval_ns = 0;

  // The data from which the result was computed, not copied: valid until the next analyze().
  const std::vector<Track>* tracks = nullptr;              ///< null after a restart
  const Background* background = nullptr;                  ///< null when `model` is nothing
  const std::vector<MovingObject>* object_list = nullptr;  ///< null when `motion` looks for none
};

/// image → features → tracks → motion model → motion → filter → gain controller → wrench. One
/// thread at a time.
///
/// A frame that shows the previous picture again does not tell whether anything moves. It is
/// reported as `repeated` for up to Cadence::kRest_ns, or for as long as the film has repeated
/// pictures before; after that it counts as rest.
class MotionAnalyzer {
 public:
  /// Throws std::invalid_argument when a setting is out of range, as configure() does.
  explicit MotionAnalyzer(const AnalyzerSettings& settings = {});
  ~MotionAnalyzer();

  /// Takes effect with the next frame; what the controller has learnt stays unless its kind
  /// changes, and so do the tracks. Throws std::invalid_argument when a setting is out of range,
  /// and then changes nothing.
  void configure(const AnalyzerSettings& settings);

  /// Frames must come in the order in which they are shown. A running time that does not rise
  /// causes a restart, because the interval would not be positive. A cut in the picture or a new
  /// size restarts tracks and filter only: the largest speed of eq. 13 and what the adaptive
  /// controller has learnt belong to the whole video.
  /// Throws std::invalid_argument for a frame that require_usable() refuses.
  FrameAnalysis analyze(const ImageView& frame, int64_t running_time_ns);

  /// Takes a frame that is known to repeat the previous picture, without analysing it. Returns
  /// nothing when the picture has been repeated for too long, or when there is no previous picture:
  /// then it is at rest, and the next frame is not compared with the one before.
  std::optional<FrameAnalysis> repeat(int64_t running_time_ns);

  /// After a flush, a seek or a discontinuity: the next frame has no motion, and the controller
  /// starts again.
  void restart();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spidar
