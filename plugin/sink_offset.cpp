#include "plugin/sink_offset.h"

#include <gst/base/gstbasesink.h>

#include "plugin/downstream.h"

namespace spidar {

void SinkOffset::follow(GstElement* element) {
  forget();
  sink_ = find_downstream(element, [](GstElement* candidate) {
    return GST_IS_BASE_SINK(candidate) && gst_base_sink_get_sync(GST_BASE_SINK(candidate));
  });
}

void SinkOffset::forget() {
  gst_clear_object(&sink_);
}

GstClockTimeDiff SinkOffset::value_ns() const {
  return sink_ ? gst_base_sink_get_ts_offset(GST_BASE_SINK(sink_)) : 0;
}

}  // namespace spidar
