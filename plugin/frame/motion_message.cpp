// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/frame/motion_message.h"

#include <utility>

#include "core/motion/objects/moving_object.h"
#include "plugin/gobject/bus_messages.h"

namespace spidar {
namespace {

/// Of the one object that is felt; 0 if it is none, or not one alone.
double felt_error_px_s(const Frame& frame) {
  const MovingObject* const felt = find_object(frame.objects, frame.felt_object);
  return felt ? felt->error_px_s : 0;
}

}  // namespace

void set_motion(GstStructure* structure, const Eigen::Vector2d& velocity_px_s,
                const Wrench& wrench) {
  const Eigen::Vector3d &force_N = wrench.force_N, &torque_Nm = wrench.torque_Nm;
  const std::pair<const char*, double> fields[] = {
      {"velocity-x", velocity_px_s.x()}, {"velocity-y", velocity_px_s.y()},
      {"force-x", force_N.x()},          {"force-y", force_N.y()},
      {"force-z", force_N.z()},          {"torque-x", torque_Nm.x()},
      {"torque-y", torque_Nm.y()},       {"torque-z", torque_Nm.z()},
  };
  for (const auto& [name, value] : fields) {
    gst_structure_set(structure, name, G_TYPE_DOUBLE, value, nullptr);
  }
}

void set_area(GstStructure* structure, const PicturePart& film) {
  gst_structure_set(structure, "area-x", G_TYPE_UINT, static_cast<guint>(film.x), "area-y",
                    G_TYPE_UINT, static_cast<guint>(film.y), "area-width", G_TYPE_UINT,
                    static_cast<guint>(film.width), "area-height", G_TYPE_UINT,
                    static_cast<guint>(film.height), nullptr);
}

void describe_no_force(NoForceReason film, NoForceReason device, GstStructure* structure) {
  gst_structure_set(structure, "no-force-reason", G_TYPE_STRING, nick(film), "no-force-text",
                    G_TYPE_STRING, sentence(film), "device-no-force-reason", G_TYPE_STRING,
                    nick(device), "device-no-force-text", G_TYPE_STRING, sentence(device), nullptr);
}

void post_motion_message(GstElement* element, GstClockTime timestamp, GstClockTime duration,
                         const FrameReport& report, gint* unread) {
  if (is_full_of_unread(*unread)) return;
  const Frame& frame = report.frame;
  GstStructure* s = gst_structure_new(
      "spidar-motion",                                                              //
      "timestamp", G_TYPE_UINT64, timestamp,                                        //
      "stream-time", G_TYPE_UINT64, static_cast<guint64>(frame.stamp.stream_ns),    //
      "running-time", G_TYPE_UINT64, static_cast<guint64>(frame.stamp.running_ns),  //
      "duration", G_TYPE_UINT64, duration,                                          //
      "repeated", G_TYPE_BOOLEAN, is_again(frame.picture) ? TRUE : FALSE,           //
      "features", G_TYPE_UINT, static_cast<guint>(frame.features),                  //
      "tracked", G_TYPE_UINT, static_cast<guint>(frame.motion.tracked),             //
      "object", G_TYPE_UINT, frame.felt_object,                                     //
      "track", G_TYPE_STRING, report.track ? report.track->c_str() : "",            //
      nullptr);
  set_area(s, report.film_part());
  set_motion(s, frame.motion.velocity_px_s, frame.wrench);
  gst_structure_set(s, "velocity-error", G_TYPE_DOUBLE, felt_error_px_s(frame), nullptr);
  describe_no_force(report.no_force, report.device_no_force, s);
  post_counted(element, gst_message_new_element(GST_OBJECT(element), s), *unread);
}

}  // namespace spidar
