// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/analysis/frame.h"
#include "core/force/gain_controller.h"
#include "core/motion/image_motion.h"
#include "core/orientation.h"
#include "plugin/frame/frame_luma.h"
#include "plugin/frame/touch_view.h"
#include "plugin/reasons/no_force.h"
#include "plugin/timing/frame_pacer.h"

namespace spidar {

/// The scene that a frame belongs to.
struct FilmScene {
  std::shared_ptr<const std::string> path;  ///< null or empty: the film is not a file
  /// When the scene, or the seen part of it, began: at a cut, or after a seek. −1: unknown.
  int64_t begin_ns = -1;
  int64_t length_ns = 0;  ///< of the film; 0: unknown

  std::string name() const { return path ? *path : ""; }
};

enum class PointOwner {
  kUnknown,     ///< no model was applied, or none explains the point
  kBackground,  ///< moves with the background
  kObject,
};

/// A point, in pixels of the whole frame, with (0, 0) at the centre of the first pixel.
struct OwnedPoint {
  uint32_t id = 0;
  ImagePoint from, to;
  PointOwner owner = PointOwner::kUnknown;
  uint32_t object = 0;  ///< id of its object; 0 if none
  bool is_new = false;  ///< not in the previous frame
};

/// What was found in a frame, or why nothing was, for message, trace and warnings.
struct FrameReport {
  enum class Fault {
    kNone,
    kNoTimestamp,  ///< no PTS, or no time in the PTS or its segment: it cannot be rendered in time
    kSameTimestamp,     ///< as the previous frame, or nearly so: no Δt to divide by
    kFallingTimestamp,  ///< before the previous frame
    kTooSmall,          ///< less memory than the picture needs
    kNotShown,          ///< outside the segment, or cropped to less than FrameLuma::kSmallestSide
    kWrongSize,         ///< more or less than FrameLuma accepts
    kSmallHalf,         ///< depth in a half leaves a picture of less than 16 px on a side
    kSmallArea,         ///< the property `area` leaves less than 16 px on a side
  };

  FrameStamp stamp;  ///< the times at the element
  Fault fault = Fault::kNone;
  bool analyzed = false;
  /// The file of the haptic track that is played; null: none, and the frame is measured.
  std::shared_ptr<const std::string> track;
  /// In pixels of the stored frame, with the wrench turned as the picture is shown. While a haptic
  /// track is played, only interval and wrench are set.
  Frame frame;
  Orientation turn;                                      ///< of the frame before it is shown
  PicturePart visible;                                   ///< the part of the frame that is picture
  int64_t took_ns = 0;                                   ///< for the analysis
  NoForceReason no_force = NoForceReason::kNone;         ///< of this frame, in the film
  NoForceReason device_no_force = NoForceReason::kNone;  ///< of device and playback, at this moment
  TouchScene touch;

  /// The part of the frame that shows the film: the whole picture if nothing was analysed.
  PicturePart film_part() const {
    if (!has_area()) return visible;
    const PicturePart& area = frame.place.area;
    return {visible.x + area.x, visible.y + area.y, area.width, area.height};
  }
  /// Whether the film covers only a part of the picture.
  bool has_area() const {
    const FilmPlace& place = frame.place;
    return place.area != PicturePart{0, 0, place.picture_width, place.picture_height};
  }
  /// Whether there is a wrench, of the analysis or of a haptic track.
  bool has_wrench() const { return analyzed || track; }
};

/// A report with what overlay, window and metas need in addition.
struct DrawnFrame : FrameReport {
  MotionKind motion = MotionKind::kObject;  ///< which motion is felt
  ControllerSettings controller;
  uint32_t click = 0;                   ///< the click whose object is kept; 0: none
  std::optional<TouchMark> touch_mark;  ///< where the grip is when the frame passes the element
  FilmScene film;                       ///< for the window
  double speed_px_s = 0;  ///< the input of the controller, in the reference frame; for the window
  std::vector<OwnedPoint> points;
  std::vector<ImagePoint> lost;  ///< the last positions of the lost points
  std::vector<uint32_t> felt;    ///< ids of the objects that are felt, see felt_objects()
  bool has_subtitles = false;    ///< whether subtitles cover the lower edge
};

}  // namespace spidar
