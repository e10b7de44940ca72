// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The result of the analysis of one frame.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/choice/chosen.h"
#include "core/motion/background.h"
#include "core/motion/image_motion.h"
#include "core/motion/motion_models.h"
#include "core/motion/moving_object.h"
#include "core/tracking/tracker.h"
#include "core/wrench.h"

namespace spidar {

struct FrameAnalysis {
  int width = 0;  ///< of the frame, px
  int height = 0;
  int features = 0;    ///< points looked for in the next frame
  ImageMotion motion;  ///< the one that is felt, unfiltered, in px/s of the frame as given
  /// Model of the background; nothing when `motion` needs none, and after a restart.
  std::optional<ModelKind> model;
  uint32_t felt_object = 0;  ///< id of the one object that is felt; 0: none, or not one alone
  Chosen choice;             ///< without `object`
  int objects = 0;           ///< how many are known; 0 when `motion` needs none
  Wrench wrench;             ///< wanted by the controller, before any safety limit
  bool restarted = false;    ///< there was nothing to compare with: motion and wrench are zero
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

}  // namespace spidar
