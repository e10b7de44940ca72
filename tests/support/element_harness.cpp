// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/support/element_harness.h"

#include "plugin/filter/spidar_motion.h"
#include "tests/support/video_frames.h"

namespace spidar::test {

void init_gstreamer() {
  static const bool done = [] {
    // This also lets the program run by hand.
    g_setenv("SPIDAR_PROFILE_PATH", SPIDAR_SOURCE_PROFILES, FALSE);
    gst_init(nullptr, nullptr);
    return GST_ELEMENT_REGISTER(spidarmotion, nullptr) != FALSE;
  }();
  (void)done;
}

MotionMessage parse_motion_message(GstMessage* message) {
  const GstStructure* s = gst_message_get_structure(message);
  MotionMessage m;
  Eigen::Vector3d& f = m.wrench.force_N;
  Eigen::Vector3d& t = m.wrench.torque_Nm;
  const bool complete = gst_structure_get(
      s, "timestamp", G_TYPE_UINT64, &m.timestamp, "stream-time", G_TYPE_UINT64, &m.stream_time,
      "running-time", G_TYPE_UINT64, &m.running_time, "duration", G_TYPE_UINT64, &m.duration,
      "features", G_TYPE_UINT, &m.features, "tracked", G_TYPE_UINT, &m.tracked, "velocity-x",
      G_TYPE_DOUBLE, &m.velocity_x, "velocity-y", G_TYPE_DOUBLE, &m.velocity_y, "force-x",
      G_TYPE_DOUBLE, &f.x(), "force-y", G_TYPE_DOUBLE, &f.y(), "force-z", G_TYPE_DOUBLE, &f.z(),
      "torque-x", G_TYPE_DOUBLE, &t.x(), "torque-y", G_TYPE_DOUBLE, &t.y(), "torque-z",
      G_TYPE_DOUBLE, &t.z(), nullptr);
  gboolean repeated = FALSE;
  const char* const no_force = gst_structure_get_string(s, "no-force-reason");
  const bool says_more = no_force && gst_structure_get_boolean(s, "repeated", &repeated);
  if (!complete || !says_more)
    g_error("incomplete spidar-motion message: %s", gst_structure_to_string(s));
  m.repeated = repeated != FALSE;
  m.no_force = no_force;
  if (const char* const of_device = gst_structure_get_string(s, "device-no-force-reason")) {
    m.device_no_force = of_device;
  }
  if (const char* const track = gst_structure_get_string(s, "track")) m.track = track;
  if (const char* const text = gst_structure_get_string(s, "no-force-text")) {
    m.no_force_text = text;
  }
  return m;
}

// Without a filter, the force of a frame is a plain function of that frame.
static const std::string kPaper = "spidarmotion motion=mean filter-min-cutoff=0 ";

ElementHarness::ElementHarness(const std::string& properties, std::function<int64_t()> now) {
  init_gstreamer();
  GError* error = nullptr;
  GstElement* element = gst_parse_launch((kPaper + properties).c_str(), &error);
  if (!element || error) g_error("%s", error ? error->message : "no element");
  gst_spidar_motion_state(GST_SPIDAR_MOTION(element)).feed.output.set_manual(std::move(now));
  bus_ = gst_bus_new();
  gst_element_set_bus(element, bus_);
  harness_ = gst_harness_new_with_element(element, "sink", "src");
  gst_object_unref(element);
}

ElementHarness::~ElementHarness() {
  gst_harness_teardown(harness_);
  gst_bus_set_flushing(bus_, TRUE);  // its messages hold the element, which holds the bus
  gst_object_unref(bus_);
}

void ElementHarness::set_caps(GstCaps* caps) {
  gst_video_info_from_caps(&info_, caps);
  gst_harness_set_src_caps(harness_, caps);
}

GstFlowReturn ElementHarness::push(GstBuffer* frame, GstClockTime pts, guint flags) {
  GST_BUFFER_PTS(frame) = pts;
  GST_BUFFER_FLAG_SET(frame, flags);
  return gst_harness_push(harness_, frame);
}

GstBuffer* ElementHarness::pass(GstBuffer* frame, GstClockTime pts, guint flags) {
  if (const GstFlowReturn flow = push(frame, pts, flags); flow != GST_FLOW_OK) {
    g_error("the frame is refused: %s", gst_flow_get_name(flow));
  }
  return gst_harness_pull(harness_);
}

GstFlowReturn ElementHarness::push_moved(double dx, double dy, GstClockTime pts, guint flags) {
  return push(make_frame(info_, dx, dy), pts, flags);
}

void ElementHarness::drain() {
  while (GstMessage* message = gst_bus_pop(bus_)) {
    GError* error = nullptr;
    switch (GST_MESSAGE_TYPE(message)) {
      case GST_MESSAGE_ELEMENT:
        if (gst_message_has_name(message, "spidar-motion")) {
          motions_.push_back(parse_motion_message(message));
        }
        break;
      case GST_MESSAGE_WARNING:
        gst_message_parse_warning(message, &error, nullptr);
        warnings_.emplace_back(error->message);
        break;
      case GST_MESSAGE_ERROR:
        gst_message_parse_error(message, &error, nullptr);
        errors_.emplace_back(error->message);
        break;
      default:
        break;
    }
    g_clear_error(&error);
    gst_message_unref(message);
  }
}

const std::vector<MotionMessage>& ElementHarness::motions() {
  drain();
  return motions_;
}

const std::vector<std::string>& ElementHarness::warnings() {
  drain();
  return warnings_;
}

const std::vector<std::string>& ElementHarness::errors() {
  drain();
  return errors_;
}

std::string ElementHarness::stats_field(const char* name) const {
  GstStructure* stats = nullptr;
  g_object_get(harness_->element, "stats", &stats, nullptr);
  const GValue* const value = gst_structure_get_value(stats, name);
  std::string text;
  if (value && G_VALUE_HOLDS_STRING(value)) {
    if (const char* const held = g_value_get_string(value)) text = held;
  } else if (value) {
    g_autofree gchar* written = gst_value_serialize(value);
    text = written;
  }
  gst_structure_free(stats);
  return text;
}

filter::MotionState& ElementHarness::state() {
  return gst_spidar_motion_state(GST_SPIDAR_MOTION(harness_->element));
}

}  // namespace spidar::test
