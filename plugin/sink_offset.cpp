#include "plugin/sink_offset.h"

#include <gst/base/gstbasesink.h>

namespace spidar {
namespace {

/// Ends a search that goes round in a circle.
constexpr int kMaxPads = 256;

/// The sink that what comes out of `src` ends in, or null; the caller unrefs it. `pads_left` counts
/// what was looked at.
GstElement* find_sink(GstPad* src, int& pads_left);

/// Takes `sink_pad`.
GstElement* find_sink_behind(GstPad* sink_pad, int& pads_left) {
  GstElement* sink = nullptr;
  // Of a bin's pad the links go on inside, and its parent is not looked at.
  GstElement* const parent = gst_pad_get_parent_element(sink_pad);
  if (parent && GST_IS_BASE_SINK(parent) && gst_base_sink_get_sync(GST_BASE_SINK(parent))) {
    sink = GST_ELEMENT(gst_object_ref(parent));
  } else if (GstIterator* const links = gst_pad_iterate_internal_links(sink_pad)) {
    GValue link = G_VALUE_INIT;
    while (!sink && gst_iterator_next(links, &link) == GST_ITERATOR_OK) {
      sink = find_sink(GST_PAD(g_value_get_object(&link)), pads_left);
      g_value_reset(&link);
    }
    g_value_unset(&link);
    gst_iterator_free(links);
  }
  if (parent) gst_object_unref(parent);
  gst_object_unref(sink_pad);
  return sink;
}

GstElement* find_sink(GstPad* src, int& pads_left) {
  GstPad* const peer = --pads_left > 0 ? gst_pad_get_peer(src) : nullptr;
  return peer ? find_sink_behind(peer, pads_left) : nullptr;
}

}  // namespace

void SinkOffset::follow(GstElement* element) {
  forget();
  GstPad* const src = gst_element_get_static_pad(element, "src");
  if (!src) return;
  int pads_left = kMaxPads;
  sink_ = find_sink(src, pads_left);
  gst_object_unref(src);
}

void SinkOffset::forget() {
  gst_clear_object(&sink_);
}

GstClockTimeDiff SinkOffset::value_ns() const {
  return sink_ ? gst_base_sink_get_ts_offset(GST_BASE_SINK(sink_)) : 0;
}

}  // namespace spidar
