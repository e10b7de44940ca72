// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/bus_warnings.h"

#include <algorithm>
#include <vector>

#include "plugin/gobject/category.h"
#include "plugin/gobject/downstream.h"

#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT spidar::category_of(element_)

namespace spidar {

void BusWarnings::start() {
  begin_stream();
  trace_ = false;
  device_.start();
}

void BusWarnings::check_bins() {
  const std::vector<Ref<GstObject>> bins = bins_around(element_);
  const bool in_timeline = std::any_of(bins.begin(), bins.end(), [](const Ref<GstObject>& bin) {
    return g_strcmp0(G_OBJECT_TYPE_NAME(bin.get()), "NleComposition") == 0;
  });
  if (!in_timeline) return;
  GST_ELEMENT_WARNING(element_, STREAM, FORMAT,
                      ("As an effect of an editing timeline, most of the video is not felt, or is "
                       "felt at the wrong time."),
                      ("Each clip of GES has its own running time, and seeks that the sink is not "
                       "notified of. Put spidarmotion behind the timeline instead, for example "
                       "with ges-launch-1.0 --videosink=\"spidarmotion ! autovideosink\"."));
}

void BusWarnings::check_trace(int error) {
  if (error == 0 || trace_) return;
  trace_ = true;
  GST_ELEMENT_WARNING(element_, RESOURCE, WRITE,
                      ("The trace can no longer be written: %s.", g_strerror(error)),
                      ("The video continues without the trace."));
}

void BusWarnings::check_frame(const FrameReport& report) {
  check_trace(report.trace_error);
  const guint bit = 1u << static_cast<guint>(report.problem);
  if (frame_problems_ & bit) return;
  frame_problems_ |= bit;
  switch (report.problem) {
    case FrameProblem::kNoTimestamp:
      GST_ELEMENT_WARNING(
          element_, STREAM, FORMAT,
          ("Frames without a timestamp cannot be felt in time; they are only shown."),
          ("The buffer has no PTS, or its PTS is decades ahead, or the segment is not in time "
           "format (for example raw frames from a filesrc). A videorate, a rawvideoparse or a "
           "parser before the decoder adds timestamps."));
      break;
    case FrameProblem::kSameTimestamp:
      GST_ELEMENT_WARNING(
          element_, STREAM, FORMAT,
          ("Two frames have the same timestamp, or nearly so; the second one is shown but not "
           "felt."),
          ("No velocity is computed from two frames that are less than half a millisecond, or an "
           "eighth of the usual time between two frames, apart."));
      break;
    case FrameProblem::kFallingTimestamp:
      GST_ELEMENT_WARNING(
          element_, STREAM, FORMAT,
          ("Timestamps go back without a discontinuity; the measurement of motion restarts."),
          ("Running time must increase within a segment."));
      break;
    case FrameProblem::kTooSmall:
      GST_ELEMENT_WARNING(
          element_, STREAM, FORMAT,
          ("A frame has less memory than its picture needs; it is passed on but not felt."),
          ("The strides and offsets of its GstVideoMeta do not fit it."));
      break;
    case FrameProblem::kWrongSize:
      GST_ELEMENT_WARNING(element_, STREAM, FORMAT,
                          ("Frames with a side below %d or above %d pixels are only shown.",
                           FrameLuma::kSmallestSide, FrameLuma::kLargestSide),
                          ("A videoscale before the element makes them smaller or larger."));
      break;
    case FrameProblem::kSmallHalf:
      GST_ELEMENT_WARNING(
          element_, STREAM, FORMAT,
          ("The half that is picture is smaller than %d x %d pixels; it is neither felt "
           "nor touched.",
           FrameLuma::kSmallestSide, FrameLuma::kSmallestSide),
          ("Half of the frame is picture and half is depth. Larger frames are felt; with "
           "touch=off or luma, the whole frame is picture."));
      break;
    case FrameProblem::kNone:
    case FrameProblem::kNotShown:
      break;
  }
}

void BusWarnings::check_touch(const MotionEngine& engine, const FrameReport& report,
                              const TouchProperties& wanted) {
  const guint bit = 1u << static_cast<guint>(report.touch_problem);
  if (touch_problems_ & bit) return;
  touch_problems_ |= bit;
  switch (report.touch_problem) {
    case TouchProblem::kNoDevice:
      GST_ELEMENT_WARNING(
          element_, RESOURCE, SETTINGS, ("There is no device to touch the picture with."),
          ("Either device=none is set, or the device could not be opened, as a warning has said; "
           "the simulated one is device=sim."));
      break;
    case TouchProblem::kNoDepthAxis:
      GST_ELEMENT_WARNING(element_, RESOURCE, SETTINGS,
                          ("The device %s cannot touch the picture: it %s.",
                           engine.output().session()->grip().name().c_str(),
                           engine.output().session()->grip().abilities().force[2]
                               ? "does not measure how far the grip is from it"
                               : "gives no force towards the viewer"),
                          ("With touch=off the motion of the video is felt."));
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
    case TouchProblem::kLagUnknown:
      GST_ELEMENT_WARNING(
          element_, RESOURCE, SETTINGS,
          ("touch-stiffness is %g N/m, but the lag of this device's drives has not been measured; "
           "the surface has %.0f N/m.",
           wanted.stiffness_N_m, report.stiffness_N_m),
          ("Measure it with spidarctl selftest --lag, and write drive_lag_s into the profile "
           "(docs/touch.md)."));
      break;
    case TouchProblem::kNone:
      break;
  }
}

void BusWarnings::check_pointer(const MotionEngine& engine) {
  const HapticSession* const session = engine.output().session();
  if (pointer_ || !session || session->grip().abilities().can_point()) return;
  pointer_ = true;
  GST_ELEMENT_WARNING(element_, RESOURCE, SETTINGS,
                      ("The grip of the device %s cannot point at the picture, because its "
                       "position is not measured; it points at the middle.",
                       session->grip().name().c_str()),
                      ("pointer=X,Y chooses the position, with "
                       "pointer=mouse the mouse does."));
}

const char* words_of(FrameProblem problem) {
  switch (problem) {
    case FrameProblem::kNone:
      return "a haptic track is played";
    case FrameProblem::kNoTimestamp:
      return "it has no timestamp";
    case FrameProblem::kSameTimestamp:
      return "its timestamp is equal or nearly equal to that of the previous frame";
    case FrameProblem::kFallingTimestamp:
      return "its timestamp is earlier than that of the previous frame";
    case FrameProblem::kTooSmall:
      return "it has less memory than its picture needs";
    case FrameProblem::kNotShown:
      return "it is outside the segment or cropped to nothing";
    case FrameProblem::kWrongSize:
      return "one of its sides is too short or too long";
    case FrameProblem::kSmallHalf:
      return "the half of it that is picture is too small";
  }
  return "unknown problem";
}

}  // namespace spidar
