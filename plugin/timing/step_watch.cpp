// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/timing/step_watch.h"

#include "plugin/engine/motion_engine.h"
#include "plugin/spidar_motion.h"
#include "plugin/timing/downstream.h"

namespace spidar {
namespace {

void on_step_done(GstBus*, GstMessage* message, gpointer element) {
  gboolean flush = FALSE;
  guint64 duration = GST_CLOCK_TIME_NONE;
  gst_message_parse_step_done(message, nullptr, nullptr, nullptr, &flush, nullptr, &duration,
                              nullptr);
  // After a step without a flush the pipeline distributes a new base time.
  if (!flush || !GST_CLOCK_TIME_IS_VALID(duration)) return;
  const bool is_behind =
      !find_path_downstream(GST_ELEMENT(element),
                            [message](GstElement* candidate) {
                              return GST_OBJECT(candidate) == GST_MESSAGE_SRC(message);
                            })
           .steps()
           .empty();
  if (!is_behind) return;
  gst_spidar_motion_engine(GST_SPIDAR_MOTION(element)).skip(duration);
}

}  // namespace

void StepWatch::begin(GstElement* element) {
  GstObject* top = GST_OBJECT(gst_object_ref(element));
  while (GstObject* parent = gst_object_get_parent(top)) {
    gst_object_unref(top);
    top = parent;
  }
  bus_ = gst_element_get_bus(GST_ELEMENT(top));
  gst_object_unref(top);
  if (!bus_) return;
  gst_bus_enable_sync_message_emission(bus_);
  handler_ = g_signal_connect_object(bus_, "sync-message::step-done", G_CALLBACK(on_step_done),
                                     element, static_cast<GConnectFlags>(0));
}

void StepWatch::end() {
  if (!bus_) return;
  g_signal_handler_disconnect(bus_, handler_);
  gst_bus_disable_sync_message_emission(bus_);
  gst_object_unref(bus_);
  bus_ = nullptr;
}

}  // namespace spidar
