#include "plugin/reports/complaints.h"

#include <string>

#include "spidar/loop/motor_heat.h"

GST_DEBUG_CATEGORY_EXTERN(gst_spidar_motion_debug);
#define GST_CAT_DEFAULT gst_spidar_motion_debug

namespace spidar {
namespace {

/// A hand that moves a slack string about loses the pose for a moment; that is not worth a word.
constexpr int64_t kPoseLost_ns = 500'000'000;

}  // namespace

void Complaints::start() {
  frame_problems_ = 0;
  strings_ = 0;
  pose_lost_ = held_back_ = false;
  haptic_trace_ = false;
  device_state_ = DeviceState::kClosed;
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

void Complaints::look_at_haptic_trace(const MotionEngine& engine) {
  const int error = engine.session() ? engine.session()->trace_error() : 0;
  if (error == 0 || haptic_trace_) return;
  haptic_trace_ = true;
  GST_ELEMENT_WARNING(element_, RESOURCE, WRITE,
                      ("The haptic trace cannot be written any more: %s.", g_strerror(error)),
                      ("The video and the force go on without it."));
}

void Complaints::look_at_strings(const MotionEngine& engine) {
  const int string = engine.faulty_string();
  if (string < 0 || (strings_ & 1u << string) != 0) return;
  strings_ |= 1u << string;
  GST_ELEMENT_WARNING(
      element_, RESOURCE, READ,
      ("String %d of the haptic device is slack or its encoder is at fault.", string),
      ("Its length fits no pose of the others: it is left out, and the force is reduced to what "
       "the "
       "others can do. If all strings are taut, the counters were not zeroed with the grip at the "
       "centre (spidarctl zero, spidarctl calibrate)."));
}

void Complaints::look_at_pose(const MotionEngine& engine) {
  const LoopSnapshot loop = engine.loop_snapshot();
  if (loop.untrusted_ns == 0 && pose_lost_) {
    GST_INFO_OBJECT(element_, "the pose of the grip is known again");
    pose_lost_ = false;
  }
  if (loop.untrusted_ns > kPoseLost_ns && !pose_lost_) {
    pose_lost_ = true;
    GST_ELEMENT_WARNING(
        element_, RESOURCE, READ,
        ("Where the grip is cannot be told: %s. There is no force until it can.",
         to_string(loop.pose_trouble)),
        ("The strings have their least tension. Slack strings, dead encoders, or counters that "
         "were "
         "not zeroed with the grip at the centre (spidarctl zero, spidarctl calibrate)."));
  }
  if (loop.held_back && loop.motor_heat > MotorHeat::kLimitFrom && !held_back_) {
    held_back_ = true;
    GST_ELEMENT_WARNING(element_, RESOURCE, WRITE,
                        ("A motor of the haptic device is warm: the force is reduced."),
                        ("Heat %.2f of what it may have for ever, see continuous_tension_N of the "
                         "profile. It goes on in full when it has cooled.",
                         loop.motor_heat));
  }
}

bool Complaints::look_at_device(const MotionEngine& engine, OnDeviceError policy) {
  look_at_strings(engine);
  look_at_pose(engine);
  look_at_haptic_trace(engine);
  const DeviceState state = engine.device_state();
  const DeviceState before = device_state_;
  device_state_ = state;
  if (state == before) return true;
  if (state != DeviceState::kLost) {
    if (before == DeviceState::kLost) GST_INFO_OBJECT(element_, "the device is back");
    return true;
  }
  GST_INFO_OBJECT(element_, "the device is lost%s", engine.device_fault().c_str());
  const std::string text = "The haptic device does not answer" + engine.device_fault() + ".";
  if (policy == OnDeviceError::kError) {
    GST_ELEMENT_ERROR(element_, RESOURCE, WRITE, ("%s", text.c_str()), ("on-device-error=error"));
    return false;
  }
  GST_ELEMENT_WARNING(element_, RESOURCE, WRITE, ("%s The video goes on without it.", text.c_str()),
                      ("It is taken back when it returns."));
  return true;
}

}  // namespace spidar
