// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <functional>
#include <utility>

#include <gst/gst.h>

#include "plugin/gobject/downstream.h"
#include "plugin/gobject/ref.h"

namespace spidar {

/// Watches steps of the sink (GST_EVENT_STEP). A sink that steps over frames with a flush shows
/// later frames that much earlier: it moves its own segment, and no element upstream is informed.
/// The only sign is the message STEP_DONE, so this class listens to the pipeline's bus.
class StepWatch {
 public:
  /// Calls `skipped` with the running time that a sink behind `element` has skipped, in the thread
  /// that posts the message.
  StepWatch(GstElement* element, std::function<void(GstClockTime)> skipped)
      : element_(element), skipped_(std::move(skipped)) {}

  /// Call begin() and end() only in state changes of the element.
  void begin() {
    bus_.reset(gst_element_get_bus(GST_ELEMENT(root_of(element_).get())));
    if (!bus_) return;
    gst_bus_enable_sync_message_emission(bus_.get());
    // The closure holds a reference to the element, which owns this watch, during each call.
    GClosure* const closure = g_cclosure_new(G_CALLBACK(on_step_done), this, nullptr);
    g_object_watch_closure(G_OBJECT(element_), closure);
    handler_ = g_signal_connect_closure(bus_.get(), "sync-message::step-done", closure, FALSE);
  }
  void end() {
    if (!bus_) return;
    g_signal_handler_disconnect(bus_.get(), handler_);
    gst_bus_disable_sync_message_emission(bus_.get());
    bus_.reset();
  }

 private:
  static void on_step_done(GstBus*, GstMessage* message, gpointer watch) {
    const auto* const self = static_cast<const StepWatch*>(watch);
    gboolean flush = FALSE;
    guint64 duration = GST_CLOCK_TIME_NONE;
    gst_message_parse_step_done(message, nullptr, nullptr, nullptr, &flush, nullptr, &duration,
                                nullptr);
    // After a step without a flush the pipeline distributes a new base time.
    if (!flush || !GST_CLOCK_TIME_IS_VALID(duration)) return;
    const bool is_behind = !find_path_downstream(self->element_, [message](GstElement* candidate) {
                              return GST_OBJECT(candidate) == GST_MESSAGE_SRC(message);
                            }).empty();
    if (is_behind) self->skipped_(duration);
  }

  GstElement* const element_;
  const std::function<void(GstClockTime)> skipped_;
  Ref<GstBus> bus_;
  gulong handler_ = 0;
};

}  // namespace spidar
