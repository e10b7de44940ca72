// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/film_progress.h"

#include <utility>

#include "plugin/gobject/ref.h"
#include "plugin/tracks/file_pipeline.h"

namespace spidar::tools {

void set_properties(GstElement* motion, const RecordProperties& properties) {
  for (const auto& [name, value] : properties.values) {
    gst_util_set_object_arg(G_OBJECT(motion), name.c_str(), value.c_str());
  }
}

FilmProgress::FilmProgress(std::function<void(int percent)> tell) : tell_(std::move(tell)) {}

void FilmProgress::watch(GstElement* motion) {
  const Ref<GstPad> frames(gst_element_get_static_pad(motion, "src"));
  gst_pad_add_probe(frames.get(), GST_PAD_PROBE_TYPE_BUFFER, passes, this, nullptr);
}

GstPadProbeReturn FilmProgress::passes(GstPad* frames, GstPadProbeInfo* info, gpointer user) {
  auto& self = *static_cast<FilmProgress*>(user);
  if (self.film_ns_ == 0) gst_pad_query_duration(frames, GST_FORMAT_TIME, &self.film_ns_);
  if (self.film_ns_ <= 0) {
    self.film_ns_ = -1;  // the container does not state it
    return GST_PAD_PROBE_REMOVE;
  }
  const GstClockTime at = stream_time_of(frames, GST_PAD_PROBE_INFO_BUFFER(info));
  if (!GST_CLOCK_TIME_IS_VALID(at)) return GST_PAD_PROBE_OK;
  const int percent = static_cast<int>(100 * at / static_cast<GstClockTime>(self.film_ns_));
  if (percent > self.told_ && percent < 100) {
    self.told_ = percent;
    self.tell_(self.told_);
  }
  return GST_PAD_PROBE_OK;
}

}  // namespace spidar::tools
