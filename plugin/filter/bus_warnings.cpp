// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/bus_warnings.h"

#include <algorithm>
#include <iterator>
#include <vector>

#include "plugin/gobject/category.h"
#include "plugin/gobject/downstream.h"

#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT spidar::category_of(element_)

namespace spidar::filter {
namespace {

struct FaultTexts {
  const char* why;      // in the log
  const char* warning;  // null: no warning
  const char* advice;
};

/// In the order of the enumeration. %1$d is the shortest side of a picture and %2$d the longest.
constexpr FaultTexts kFaultTexts[] = {
    {"a haptic track is played", nullptr, nullptr},
    {"it has no timestamp",
     "Frames without a timestamp cannot be felt in time; they are only shown.",
     "The buffer has no PTS, or its PTS is decades ahead, or the segment is not in time format "
     "(for example raw frames from a filesrc). A videorate, a rawvideoparse or a parser before the "
     "decoder adds timestamps."},
    {"its timestamp is equal or nearly equal to that of the previous frame",
     "Two frames have the same timestamp, or nearly so; the second one is shown but not felt.",
     "No velocity is computed from two frames that are less than half a millisecond, or an eighth "
     "of the usual time between two frames, apart."},
    {"its timestamp is earlier than that of the previous frame",
     "Timestamps go back without a discontinuity; the measurement of motion restarts.",
     "Running time must increase within a segment."},
    {"it has less memory than its picture needs",
     "A frame has less memory than its picture needs; it is passed on but not felt.",
     "The strides and offsets of its GstVideoMeta do not fit it."},
    {"it is outside the segment or cropped to nothing", nullptr, nullptr},
    {"one of its sides is too short or too long",
     "Frames with a side below %1$d or above %2$d pixels are only shown.",
     "The shortest side is that of square pixels. A videoscale before the element makes them "
     "smaller or larger."},
    {"the half of it that is picture is too small",
     "The half that is picture is smaller than %1$d x %1$d pixels; it is neither felt nor touched.",
     "Half of the frame is picture and half is depth. Larger frames are felt; with touch=off or "
     "luma, the whole frame is picture."},
    {"area leaves too little of it",
     "Of the property area, less than %1$d x %1$d pixels lie in the picture; it is only shown.",
     "area=X,Y,WIDTH,HEIGHT counts from the top left corner of the frame; area=whole is all "
     "of it."},
};
static_assert(std::size(kFaultTexts) == static_cast<size_t>(FrameReport::Fault::kSmallArea) + 1);

const FaultTexts& texts_of(FrameReport::Fault fault) {
  return kFaultTexts[static_cast<size_t>(fault)];
}

}  // namespace

const char* fault_text(FrameReport::Fault fault) {
  return texts_of(fault).why;
}

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
  if (error == 0 || std::exchange(trace_, true)) return;
  GST_ELEMENT_WARNING(element_, RESOURCE, WRITE,
                      ("The trace can no longer be written: %s.", g_strerror(error)),
                      ("The video continues without the trace."));
}

void BusWarnings::check_frame(const FrameReport& report) {
  const FaultTexts& texts = texts_of(report.fault);
  const guint bit = 1u << static_cast<guint>(report.fault);
  if (!texts.warning || (frame_faults_ & bit)) return;
  frame_faults_ |= bit;
  GST_ELEMENT_WARNING(element_, STREAM, FORMAT,
                      (texts.warning, FrameLuma::kSmallestSide, FrameLuma::kLargestSide),
                      ("%s", texts.advice));
}

void BusWarnings::check_touch(const HapticOutput& output, const FrameReport& report,
                              const TouchProperties& wanted) {
  if (wanted.kind == TouchProperties::Kind::kOff || !report.has_wrench()) return;
  const HapticSession* const session = output.session();
  if (report.track) {
    if (std::exchange(touch_track_, true)) return;
    GST_ELEMENT_WARNING(element_, RESOURCE, SETTINGS,
                        ("The picture cannot be touched while a haptic track is played."),
                        ("Leave out track, or set touch=off."));
  } else if (!session) {
    if (std::exchange(touch_device_, true)) return;
    GST_ELEMENT_WARNING(
        element_, RESOURCE, SETTINGS, ("There is no device to touch the picture with."),
        ("Either device=none is set, or the device could not be opened, as a warning has said; the "
         "simulated one is device=sim."));
  } else if (!session->grip().abilities().can_touch()) {
    if (std::exchange(touch_device_, true)) return;
    GST_ELEMENT_WARNING(
        element_, RESOURCE, SETTINGS,
        ("The device %s cannot touch the picture: it %s.", session->grip().name().c_str(),
         session->grip().abilities().force[2] ? "does not measure how far the grip is from it"
                                              : "gives no force towards the viewer"),
        ("With touch=off the motion of the video is felt."));
  } else if (report.touch.on && report.touch.stiffness_N_m < wanted.stiffness_N_m) {
    if (std::exchange(stiffness_, true)) return;
    const bool is_measured = output.profile().drive_lag_known;
    GST_ELEMENT_WARNING(
        element_, RESOURCE, SETTINGS,
        ("touch-stiffness is %g N/m, %s %.0f N/m.", wanted.stiffness_N_m,
         is_measured ? "which this device cannot render without shaking; it is touched with"
                     : "but the lag of this device's drives has not been measured; the surface has",
         report.touch.stiffness_N_m),
        ("%s", is_measured
                   ? "The profile's drive_lag_s sets how stiff a surface may be (docs/touch.md)."
                   : "Measure it with spidarctl selftest --lag, and write drive_lag_s into the "
                     "profile (docs/touch.md)."));
  }
}

void BusWarnings::check_pointer(const HapticSession* session) {
  if (pointer_ || !session || session->grip().abilities().can_point()) return;
  pointer_ = true;
  GST_ELEMENT_WARNING(element_, RESOURCE, SETTINGS,
                      ("The grip of the device %s cannot point at the picture, because its "
                       "position is not measured; it points at the middle.",
                       session->grip().name().c_str()),
                      ("pointer=X,Y chooses the position, with "
                       "pointer=mouse the mouse does."));
}

}  // namespace spidar::filter
