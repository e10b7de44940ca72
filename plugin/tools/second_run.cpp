// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/second_run.h"

#include <utility>

#include <gst-spidar/gstspidarmotionmeta.h>

#include "plugin/tools/film_decoder.h"

namespace spidar {
namespace {

/// An element outside of the path of the frames.
GstElement* add_motion(GstElement* pipeline, const RecordProperties& properties) {
  GstElement* const motion = gst_element_factory_make("spidarmotion", nullptr);
  gst_util_set_object_arg(G_OBJECT(motion), "device", "none");
  g_object_set(motion, "attach-meta", TRUE, nullptr);
  set_properties(motion, properties);
  gst_bin_add(GST_BIN(pipeline), motion);
  return motion;
}

}  // namespace

void RunMessages::listen(GstElement* pipeline, GstElement* motion) {
  motion_ = motion;
  g_object_set(motion, "post-messages", TRUE, nullptr);
  GstBus* bus = gst_element_get_bus(pipeline);
  gst_bus_enable_sync_message_emission(bus);
  g_signal_connect(bus, "sync-message::element", G_CALLBACK(hears), this);
  gst_object_unref(bus);
}

void RunMessages::hears(GstBus*, GstMessage* message, gpointer user) {
  auto& self = *static_cast<RunMessages*>(user);
  const GstStructure* const about = gst_message_get_structure(message);
  gboolean is_same = FALSE;
  guint features = 0;
  if (GST_MESSAGE_SRC(message) != GST_OBJECT(self.motion_) ||
      !gst_structure_get(about, "repeated", G_TYPE_BOOLEAN, &is_same, "features", G_TYPE_UINT,
                         &features, nullptr)) {
    return;
  }
  const std::lock_guard<std::mutex> lock(self.lock_);
  self.found_ = FoundFrame{is_same ? Shown::kSame : Shown::kOther, 0, features};
}

std::optional<FoundFrame> RunMessages::take(GstBuffer* frame) {
  const std::lock_guard<std::mutex> lock(lock_);
  std::optional<FoundFrame> found = std::exchange(found_, {});
  GstSpidarFrameMotion motion;
  if (!found || !gst_buffer_get_spidar_motion(frame, &motion)) return {};
  found->interval_ns = motion.interval;
  if (motion.interval == 0) found->shown = Shown::kFirst;
  return found;
}

SecondRun::SecondRun(GstElement* pipeline, const RecordProperties& properties)
    : in_(gst_pad_new("frames", GST_PAD_SRC)), out_(gst_pad_new("measured", GST_PAD_SINK)) {
  GstElement* const own = add_motion(pipeline, properties);
  GstPad* sink = gst_element_get_static_pad(own, "sink");
  GstPad* src = gst_element_get_static_pad(own, "src");
  gst_pad_set_chain_function(out_, take);
  gst_pad_set_element_private(out_, this);
  gst_pad_link(in_, sink);
  gst_pad_link(src, out_);
  gst_pad_set_active(out_, TRUE);
  gst_pad_set_active(in_, TRUE);
  gst_object_unref(src);
  gst_object_unref(sink);
  messages_.listen(pipeline, own);
}

SecondRun::~SecondRun() {
  gst_pad_set_active(in_, FALSE);
  gst_pad_set_active(out_, FALSE);
  gst_object_unref(in_);
  gst_object_unref(out_);
}

GstFlowReturn SecondRun::take(GstPad* pad, GstObject*, GstBuffer* frame) {
  auto& self = *static_cast<SecondRun*>(gst_pad_get_element_private(pad));
  self.found_ = self.messages_.take(frame);
  gst_buffer_unref(frame);
  return GST_FLOW_OK;
}

std::optional<FoundFrame> SecondRun::measure(GstPad* pad, GstBuffer* frame, int part) {
  if (part_ == 0) {
    gst_pad_sticky_events_foreach(
        pad,
        [](GstPad*, GstEvent** event, gpointer in) -> gboolean {
          gst_pad_push_event(static_cast<GstPad*>(in), gst_event_ref(*event));
          return TRUE;
        },
        in_);
  }
  GstBuffer* const copy = gst_buffer_copy(frame);
  if (part != std::exchange(part_, part)) GST_BUFFER_FLAG_SET(copy, GST_BUFFER_FLAG_DISCONT);
  found_.reset();
  gst_pad_push(in_, copy);
  return found_;
}

}  // namespace spidar
