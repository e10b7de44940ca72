// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The analysis of a frame, from picture to wrench.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/api.h"
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
  /// Place of the picture that kObjects is felt at: (0, 0) is its top left corner, (1, 1) its
  /// bottom right one; finite.
  Eigen::Vector2d pointer{0.5, 0.5};
  FilterSettings filter;
  AxisGains axes;
  ControllerSettings controller;
};

/// Exactly as in the paper: OpenCV's tracker, mean velocity of all points, unfiltered, nonlinear
/// controller.
SPIDAR_API AnalyzerSettings paper_settings();

/// The result of one frame.
struct FrameAnalysis {
  int width = 0;  ///< of the frame, px
  int height = 0;
  int features = 0;    ///< points looked for in the next frame
  ImageMotion motion;  ///< the one that is felt, unfiltered, in unscaled px/s of the frame given
  /// Model of the background; nothing when `motion` needs none, and after a restart.
  std::optional<ModelKind> model;
  int objects = 0;         ///< how many are known; 0 when `motion` needs none
  Wrench wrench;           ///< wanted by the controller, before any safety limit
  bool restarted = false;  ///< nothing to compare with: motion and wrench are zero
  /// The frame shows the previous picture again, and the motion may go on: motion and wrench are
  /// those of the previous frame.
  bool repeated = false;
  /// The frame shows the picture before again, whether that waits (`repeated`) or rests: the same
  /// pixels, or what the noise of coding has made of them.
  bool same_picture = false;
  /// The time in which the motion happened, see Cadence: between two pictures, which may be more
  /// than two frames apart; 0 after a restart.
  int64_t interval_ns = 0;

  // What it was found from, not copied: valid until the next analyze().
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
class SPIDAR_API MotionAnalyzer {
 public:
  /// Throws std::invalid_argument when a setting is out of range, as configure() does.
  explicit MotionAnalyzer(const AnalyzerSettings& settings = {});
  ~MotionAnalyzer();

  /// Takes effect with the next frame; what the controller has learnt stays unless its kind
  /// changes, and so do the tracks. Throws std::invalid_argument when a setting is out of range,
  /// and then changes nothing.
  void configure(const AnalyzerSettings& settings);

  /// Frames in the order in which they are shown. A running time that does not rise restarts, for
  /// there is no Δt to divide by. A cut in the picture or a new size restarts tracks and filter
  /// only: the largest speed of eq. 13 is one over the whole video, whatever its scenes, and so is
  /// what the adaptive controller has learnt.
  /// Throws std::invalid_argument for a frame that Tracker::track() refuses.
  FrameAnalysis analyze(const ImageView& frame, int64_t running_time_ns);

  /// A frame that is known to show the picture before again, without looking at it. Nothing when it
  /// does so for too long, or when there is no picture before: then it is rest, and the next frame
  /// has nothing to do with the one before.
  std::optional<FrameAnalysis> repeat(int64_t running_time_ns);

  /// After a flush, a seek or a discontinuity: the next frame has no motion, and the controller
  /// starts again.
  void restart();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spidar
