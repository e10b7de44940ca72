// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Settings of the analysis of frames.
#pragma once

#include <memory>

#include <Eigen/Core>

#include "core/choice/chosen.h"
#include "core/force/gain_controller.h"
#include "core/force/motion_filter.h"
#include "core/force/motion_rendering.h"
#include "core/motion/image_motion.h"
#include "core/tracking/tracker.h"

namespace spidar {

struct AnalyzerSettings {
  TrackerSettings tracker;
  MotionKind motion = MotionKind::kObject;
  /// Position of the picture where kObjects is felt: (0, 0) is its top left corner, (1, 1) its
  /// bottom right one; finite.
  Eigen::Vector2d pointer{0.5, 0.5};
  /// Come before `motion` where they say something, and not with kMean, which knows no objects.
  std::shared_ptr<const FeelRules> feel;
  KeptObject kept;                            ///< comes before `feel`
  std::shared_ptr<const PictureBoxes> boxes;  ///< that came with this frame; null: none did
  FilterSettings filter;
  AxisGains axes;
  ControllerSettings controller;
  double washout_Hz = 0;  ///< cut-off of Washout, finite and ≥ 0; 0: none
};

/// Closest to the paper: mean velocity of the points of OpenCvTracker, unfiltered, nonlinear
/// controller.
AnalyzerSettings paper_settings();

/// Throws std::invalid_argument when one is out of range.
void validate(const AnalyzerSettings& settings);

}  // namespace spidar
