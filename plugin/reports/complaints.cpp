// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/reports/complaints.h"

namespace spidar {

void Complaints::start() {
  begin_stream();
  device_.start();
}

void Complaints::look_at_place() {
  bool in_timeline = false;
  GstObject* place = gst_object_get_parent(GST_OBJECT(element_));
  while (place) {
    in_timeline = in_timeline || g_strcmp0(G_OBJECT_TYPE_NAME(place), "NleComposition") == 0;
    GstObject* const outer = gst_object_get_parent(place);
    gst_object_unref(place);
    place = outer;
  }
  if (!in_timeline) return;
  GST_ELEMENT_WARNING(
      element_, STREAM, FORMAT,
      ("As an effect of an editing timeline most of the video is not felt, or at another time."),
      ("Each clip of GES has a running time of its own, and seeks that the sink does not hear of. "
       "Put "
       "spidarmotion behind the timeline instead, as with ges-launch-1.0 "
       "--videosink=\"spidarmotion ! "
       "autovideosink\"."));
}

void Complaints::look_at_frame(const FrameReport& report) {
  if (report.trace_failed) {
    GST_ELEMENT_WARNING(element_, RESOURCE, WRITE, ("The trace cannot be written any more."),
                        ("Disk full? The video goes on without it."));
  }
  const guint bit = 1u << static_cast<guint>(report.problem);
  if (frame_problems_ & bit) return;
  frame_problems_ |= bit;
  switch (report.problem) {
    case FrameProblem::kNoTimestamp:
      GST_ELEMENT_WARNING(
          element_, STREAM, FORMAT,
          ("Frames without a timestamp cannot be felt in time; they are shown only."),
          ("Buffer without PTS, or decades ahead, or a segment that is not in time (a filesrc of "
           "raw frames). A videorate, rawvideoparse or a parser before the decoder adds them."));
      break;
    case FrameProblem::kSameTimestamp:
      GST_ELEMENT_WARNING(element_, STREAM, FORMAT,
                          ("Two frames have the same timestamp, or nearly so; the second one is "
                           "shown but not felt."),
                          ("Less than an eighth of the time between two frames, or than half a "
                           "millisecond, is no time to divide a motion by."));
      break;
    case FrameProblem::kFallingTimestamp:
      GST_ELEMENT_WARNING(element_, STREAM, FORMAT,
                          ("Timestamps go back without a discontinuity; motion is measured anew."),
                          ("Running time must rise within a segment."));
      break;
    case FrameProblem::kTooSmall:
      GST_ELEMENT_WARNING(element_, STREAM, FORMAT,
                          ("A frame has less memory than its picture needs; it is passed on only."),
                          ("The strides and offsets of its GstVideoMeta do not fit it."));
      break;
    case FrameProblem::kNone:
    case FrameProblem::kNotShown:
      break;
  }
}

void Complaints::look_at_touch(const FrameReport& report, const TouchProperties& wanted) {
  const guint bit = 1u << static_cast<guint>(report.touch_problem);
  if (touch_problems_ & bit) return;
  touch_problems_ |= bit;
  switch (report.touch_problem) {
    case TouchProblem::kNoDevice:
      GST_ELEMENT_WARNING(element_, RESOURCE, SETTINGS,
                          ("There is no device to touch the picture with."),
                          ("device=none; the simulated one is device=sim."));
      break;
    case TouchProblem::kTrack:
      GST_ELEMENT_WARNING(element_, RESOURCE, SETTINGS,
                          ("The picture cannot be touched while a haptic track is played."),
                          ("Leave out track, or set touch=off."));
      break;
    case TouchProblem::kTooStiff:
      GST_ELEMENT_WARNING(
          element_, RESOURCE, SETTINGS,
          ("touch-stiffness is %g N/m, which this device cannot render without shaking; it is "
           "touched with %.0f N/m.",
           wanted.stiffness_N_m, report.stiffness_N_m),
          ("The profile's drive_lag_s sets how stiff a surface may be (docs/touch.md)."));
      break;
    case TouchProblem::kNone:
      break;
  }
}

void Complaints::look_at_overlay(const GstVideoInfo& info) {
  if (overlay_ || !is_unpacked(*info.finfo)) return;
  overlay_ = true;
  GST_ELEMENT_WARNING(
      element_, STREAM, FORMAT,
      ("The overlay cannot be drawn into frames of the format %s.", GST_VIDEO_INFO_NAME(&info)),
      ("The force is felt all the same. A videoconvert in front of the element and "
       "caps with format=I420, for example, make frames that can be drawn into."));
}

}  // namespace spidar
