// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The motion in one frame, as data for the overlay, the window and the meta.
#pragma once

#include <cstdint>
#include <vector>

#include "core/analysis/frame.h"
#include "core/motion/scene_motion.h"
#include "core/picture_turn.h"
#include "plugin/filter/frame/frame_luma.h"
#include "plugin/filter/frame/touch_view.h"

namespace spidar {

enum class TrackOwner {
  kUnknown,     ///< no model was applied, or none explains it
  kBackground,  ///< moves with the background
  kObject,
};

/// Coordinates are pixels of the uncropped frame, with (0, 0) at the centre of the first one.
struct SceneTrack {
  uint32_t id = 0;
  ImagePoint from, to;
  TrackOwner owner = TrackOwner::kUnknown;
  uint32_t object = 0;  ///< id of the object it belongs to; 0 if none
  bool is_new = false;  ///< not in the previous frame
};

struct SceneView {
  std::vector<SceneTrack> tracks;
  std::vector<ImagePoint> lost;       ///< last positions of the lost points
  std::vector<MovingObject> objects;  ///< relative to the centre of the visible part
  ImageMotion motion;                 ///< the motion that is rendered
  Wrench wrench;                      ///< turned like the picture
  uint32_t felt_object = 0;           ///< the one object that is felt; 0: none, or not one alone
  bool is_free = true;                ///< no rule and no click says what is felt
  PictureTurn turn;                   ///< of the picture before it is shown
};

/// Ids of the objects in sight whose motion is felt: one, or with MotionKind::kObjects all of which
/// nobody chose one; none while only the surface is felt.
std::vector<uint32_t> felt_objects(const SceneView& scene, MotionKind motion,
                                   const TouchScene& touch);

/// Where the arrow of the felt force begins, in pixels of the frame: on the one object that is
/// felt, where its tracks are and not merely its box, else in the middle of the picture.
Eigen::Vector2d force_origin_px(const SceneView& scene, const std::vector<uint32_t>& felt,
                                const VisiblePart& visible);

/// Corners of an object's box, in pixels of the frame.
struct ObjectCorners {
  Eigen::Vector2d low_px, high_px;
};
ObjectCorners corners_of(const MovingObject& object, const VisiblePart& visible);

/// Assigns tracks to the background or to objects, and tracks their appearance from frame to frame.
class SceneViewer {
 public:
  /// Updates the scene with a frame that was analysed in the part `visible` of the frame. The
  /// reference is valid until the next call.
  const SceneView& see(const Frame& frame, const VisiblePart& visible,
                       const PictureTurn& turn = {});
  const SceneView& scene() const { return scene_; }

  /// Clears the scene. Call before frames that are not analysed.
  void reset();

 private:
  void find_owner(const Frame& frame, const VisiblePart& visible, SceneTrack& track);
  void compare(const std::vector<SceneTrack>& before);

  SceneView scene_;
  bool compares_ = false;  ///< the previous frame was analysed for tracks
};

}  // namespace spidar
