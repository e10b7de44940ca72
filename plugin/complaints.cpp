#include "plugin/complaints.h"

#include <string>

GST_DEBUG_CATEGORY_EXTERN(gst_spidar_motion_debug);
#define GST_CAT_DEFAULT gst_spidar_motion_debug

namespace spidar {

void Complaints::start() {
  frame_problems_ = 0;
  strings_ = 0;
  device_state_ = DeviceState::kClosed;
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

void Complaints::look_at_strings(const MotionEngine& engine) {
  const int string = engine.faulty_string();
  if (string < 0 || (strings_ & 1u << string) != 0) return;
  strings_ |= 1u << string;
  GST_ELEMENT_WARNING(
      element_, RESOURCE, READ,
      ("String %d of the haptic device is slack or its encoder is at fault.", string),
      ("Its length fits no pose of the others. The grip is found without it."));
}

bool Complaints::look_at_device(const MotionEngine& engine, OnDeviceError policy) {
  look_at_strings(engine);
  const DeviceState state = engine.device_state();
  const DeviceState before = device_state_;
  device_state_ = state;
  if (state == before) return true;
  if (state != DeviceState::kLost) {
    if (before == DeviceState::kLost) GST_INFO_OBJECT(element_, "device is back");
    return true;
  }
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
