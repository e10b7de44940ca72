// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/felt_boxes.h"

#include <gst-spidar/gstspidarobjectmeta.h>

#include "plugin/gobject/ref.h"
#include "plugin/tools/film_progress.h"
#include "plugin/tools/film_watch.h"
#include "plugin/tools/record_options.h"
#include "plugin/tracks/file_end.h"
#include "plugin/tracks/file_pipeline.h"

namespace spidar::tools {
namespace {

/// Upright, as a browser shows it.
constexpr const char* kMeasuredFilm =
    "filesrc name=source ! decodebin name=decode videoconvert name=convert ! "
    "videoflip video-direction=auto ! spidarmotion name=motion device=none attach-meta=true ! "
    "fakesink sync=false";

GstPadProbeReturn measured(GstPad* pad, GstPadProbeInfo* info, gpointer user) {
  auto& boxes = *static_cast<std::vector<FeltBox>*>(user);
  GstBuffer* const frame = GST_PAD_PROBE_INFO_BUFFER(info);
  const GstClockTime at = stream_time_of(pad, frame);
  if (!GST_CLOCK_TIME_IS_VALID(at)) return GST_PAD_PROBE_OK;
  FeltBox box;
  box.stream_ns = static_cast<int64_t>(at);
  GArray* const objects = gst_buffer_get_spidar_objects(frame);
  for (guint i = 0; i < objects->len; ++i) {
    const auto& object = g_array_index(objects, GstSpidarObject, i);
    if (!object.felt) continue;
    const double width = object.width, height = object.height;
    box.edges = {object.x / width, object.y / height, (object.x + object.w) / width,
                 (object.y + object.h) / height};
  }
  g_array_unref(objects);
  boxes.push_back(box);
  return GST_PAD_PROBE_OK;
}

}  // namespace

std::vector<FeltBox> find_felt_boxes(const std::string& film, const std::string& settings) {
  const RecordProperties properties = properties_of(settings);
  std::vector<FeltBox> boxes;  // outlive the pipeline
  FilmWatch watch;
  const FilePipeline file(kMeasuredFilm, film, nullptr, kSlowShare);
  GstElement* const motion = file.find("motion");
  set_properties(motion, properties);
  watch.begin(file.pipeline(), film_end(film) == FilmEnd::kAppended);
  const Ref<GstPad> frames(gst_element_get_static_pad(motion, "src"));
  gst_pad_add_probe(frames.get(), GST_PAD_PROBE_TYPE_BUFFER, measured, &boxes, nullptr);
  watch.play(file);
  return boxes;
}

}  // namespace spidar::tools
