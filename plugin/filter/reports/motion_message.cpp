// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/reports/motion_message.h"

#include "core/motion/objects/moving_object.h"
#include "plugin/filter/reports/limit_watch.h"

namespace spidar {
namespace {

/// Of the one object that is felt; 0 if it is none, or not one alone.
double felt_error_px_s(const Frame& frame) {
  for (const MovingObject& object : frame.objects) {
    if (object.id == frame.felt_object) return object.error_px_s;
  }
  return 0;
}

}  // namespace

void post_motion_message(GstElement* element, GstBuffer* buffer, const FrameReport& report,
                         gint* unread) {
  if (g_atomic_int_get(unread) >= kMostUnread) return;
  const Frame& frame = report.frame;
  const Eigen::Vector2d& velocity = frame.motion.velocity_px_s;
  const Eigen::Vector3d& force = frame.wrench.force_N;
  const Eigen::Vector3d& torque = frame.wrench.torque_Nm;
  GstStructure* s = gst_structure_new(
      "spidar-motion",                                                        //
      "timestamp", G_TYPE_UINT64, GST_BUFFER_PTS(buffer),                     //
      "stream-time", G_TYPE_UINT64, static_cast<guint64>(frame.stream_ns),    //
      "running-time", G_TYPE_UINT64, static_cast<guint64>(frame.running_ns),  //
      "duration", G_TYPE_UINT64, GST_BUFFER_DURATION(buffer),                 //
      "repeated", G_TYPE_BOOLEAN, is_again(frame.picture) ? TRUE : FALSE,     //
      "features", G_TYPE_UINT, static_cast<guint>(frame.features),            //
      "tracked", G_TYPE_UINT, static_cast<guint>(frame.motion.tracked),       //
      "object", G_TYPE_UINT, frame.felt_object,                               //
      "velocity-x", G_TYPE_DOUBLE, velocity.x(), "velocity-y", G_TYPE_DOUBLE, velocity.y(),
      "velocity-error", G_TYPE_DOUBLE, felt_error_px_s(frame), "force-x", G_TYPE_DOUBLE, force.x(),
      "force-y", G_TYPE_DOUBLE, force.y(), "force-z", G_TYPE_DOUBLE, force.z(), "torque-x",
      G_TYPE_DOUBLE, torque.x(), "torque-y", G_TYPE_DOUBLE, torque.y(), "torque-z", G_TYPE_DOUBLE,
      torque.z(), nullptr);
  describe_limits(report.limit, report.device_limit, s);
  GstMessage* const message = gst_message_new_element(GST_OBJECT(element), s);
  g_atomic_int_inc(unread);
  // The message holds the element until then.
  const auto count_down = [](gpointer count, GstMiniObject*) {
    g_atomic_int_add(static_cast<gint*>(count), -1);
  };
  gst_mini_object_weak_ref(GST_MINI_OBJECT_CAST(message), count_down, unread);
  gst_element_post_message(element, message);
}

}  // namespace spidar
