/// What the element says on the bus when something is wrong that the video goes on without.
#pragma once

#include <gst/gst.h>

#include "plugin/motion_engine.h"
#include "plugin/properties/motion_properties.h"

namespace spidar {

/// Says each thing once a stream, not once a frame. Streaming thread, and start() before it.
class Complaints {
 public:
  explicit Complaints(GstElement* element) : element_(element) {}

  /// The element begins: everything may be said again.
  void start();
  /// Another stream: what is wrong with its frames may be.
  void begin_stream() { frame_problems_ = 0; }

  /// Looks at the bins around the element, which may have a running time of their own.
  void look_at_place();
  void look_at_frame(const FrameReport& report);
  /// Once a device, also at its end: the haptic trace cannot be written any more.
  void look_at_haptic_trace(const MotionEngine& engine);
  /// Looks at the device. False when the stream is to end, and then says why.
  bool look_at_device(const MotionEngine& engine, OnDeviceError policy);

 private:
  void look_at_strings(const MotionEngine& engine);
  void look_at_pose(const MotionEngine& engine);

  GstElement* const element_;
  guint frame_problems_ = 0;  // bit i: FrameProblem i was said
  guint strings_ = 0;         // bit i: string i
  bool pose_lost_ = false;    // said, and not come back since
  bool held_back_ = false;    // said
  bool haptic_trace_ = false;
  DeviceState device_state_ = DeviceState::kClosed;
};

}  // namespace spidar
