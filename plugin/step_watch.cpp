#include "plugin/step_watch.h"

#include "plugin/motion_engine.h"
#include "plugin/spidar_motion.h"

namespace spidar {
namespace {

bool leads_to(GstPad* source, const GstObject* sink);

/// Whether what comes into this pad goes on to `sink`.
bool feeds(GstPad* pad, const GstObject* sink) {
  GstElement* element = gst_pad_get_parent_element(pad);  // null: inside of a ghost pad
  bool found = element && GST_OBJECT(element) == sink;
  if (element) gst_object_unref(element);
  GstIterator* links = found ? nullptr : gst_pad_iterate_internal_links(pad);
  if (!links) return found;
  GValue item = G_VALUE_INIT;
  while (!found && gst_iterator_next(links, &item) == GST_ITERATOR_OK) {
    found = leads_to(static_cast<GstPad*>(g_value_get_object(&item)), sink);
    g_value_reset(&item);
  }
  g_value_unset(&item);
  gst_iterator_free(links);
  return found;
}

bool leads_to(GstPad* source, const GstObject* sink) {
  GstPad* peer = gst_pad_get_peer(source);
  if (!peer) return false;
  const bool found = feeds(peer, sink);
  gst_object_unref(peer);
  return found;
}

void on_step_done(GstBus*, GstMessage* message, gpointer element) {
  gboolean flush = FALSE;
  guint64 duration = GST_CLOCK_TIME_NONE;
  gst_message_parse_step_done(message, nullptr, nullptr, nullptr, &flush, nullptr, &duration,
                              nullptr);
  // Without a flush the pipeline distributes another base time.
  if (!flush || !GST_CLOCK_TIME_IS_VALID(duration)) return;
  if (!leads_to(GST_BASE_TRANSFORM_SRC_PAD(element), GST_MESSAGE_SRC(message))) return;
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
