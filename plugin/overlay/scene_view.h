// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What is seen moving in one frame, as data: for the overlay, the window and the meta.
#pragma once

#include <cstdint>
#include <vector>

#include "core/motion/objects.h"
#include "core/motion_analyzer.h"
#include "plugin/engine/frame_luma.h"

namespace spidar {

enum class TrackOwner {
  kUnknown,     ///< no model looked at it, or none explains it
  kBackground,  ///< moves as the background does
  kObject,
};

/// Pixels of the frame, crop and all; the centre of its first pixel is (0, 0).
struct SceneTrack {
  uint32_t id = 0;
  ImagePoint from, to;
  TrackOwner owner = TrackOwner::kUnknown;
  uint32_t object = 0;  ///< id of the object it is on; 0 for the others
  bool is_new = false;  ///< not followed to the frame before
};

struct SceneView {
  std::vector<SceneTrack> tracks;
  std::vector<ImagePoint> lost;       ///< where points were that are not found any more
  std::vector<MovingObject> objects;  ///< about the centre of what is visible
  ImageMotion motion;                 ///< the one that is felt
  Wrench wrench;
};

/// Which of the tracks belongs to what, from frame to frame.
class SceneViewer {
 public:
  /// `analysis` as analyze() just gave it, of the part `visible` of the frame. The result is valid
  /// until the next call.
  const SceneView& see(const FrameAnalysis& analysis, const VisiblePart& visible);
  const SceneView& scene() const { return scene_; }

  /// Nothing is known: before frames that are not analysed.
  void reset();

 private:
  void find_owner(const FrameAnalysis& analysis, const VisiblePart& visible, SceneTrack& track);
  void compare(const std::vector<SceneTrack>& before);

  SceneView scene_;
  bool compares_ = false;  ///< the frame before had tracks to compare with
};

}  // namespace spidar
