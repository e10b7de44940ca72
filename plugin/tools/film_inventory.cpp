// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/film_inventory.h"

#include <algorithm>

#include "plugin/track/file_pipeline.h"

namespace spidar {
namespace {

GstPadProbeReturn count_packet(GstPad*, GstPadProbeInfo*, gpointer file) {
  static_cast<const FilePipeline*>(file)->advance();
  return GST_PAD_PROBE_OK;
}

void discard(GstElement*, GstPad* pad, gpointer user) {
  const auto& file = *static_cast<const FilePipeline*>(user);
  GstPad* into = gst_element_get_static_pad(file.add_fakesink(), "sink");
  gst_pad_link(pad, into);
  gst_object_unref(into);
  gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_BUFFER, count_packet, user, nullptr);
}

void read_tags(GstPad* pad, FilmStream& stream) {
  for (guint i = 0; GstEvent* event = gst_pad_get_sticky_event(pad, GST_EVENT_TAG, i); ++i) {
    GstTagList* tags = nullptr;
    gst_event_parse_tag(event, &tags);
    gchar* text = nullptr;
    if (gst_tag_list_get_string(tags, GST_TAG_IMAGE_ORIENTATION, &text)) stream.orientation = text;
    g_free(text);
    stream.has_cover = stream.has_cover || gst_tag_list_get_tag_size(tags, GST_TAG_IMAGE) > 0;
    gst_event_unref(event);
  }
}

}  // namespace

std::string stream_id(GstPad* pad) {
  gchar* const text = gst_pad_get_stream_id(pad);
  const std::string id = text ? text : "";
  g_free(text);
  return id;
}

std::vector<FilmStream> list_streams(const std::string& film) {
  const FilePipeline file("filesrc name=source ! parsebin name=parse", film, nullptr);
  GstElement* const parser = file.find("parse");
  g_signal_connect(parser, "pad-added", G_CALLBACK(discard), const_cast<FilePipeline*>(&file));
  file.play_until(GST_MESSAGE_EOS);
  std::vector<FilmStream> streams;
  for (GList* i = parser->srcpads; i; i = i->next) {
    auto* const pad = static_cast<GstPad*>(i->data);
    GstCaps* const caps = gst_pad_get_current_caps(pad);
    if (!caps) continue;  // announced, but not there
    streams.push_back({stream_id(pad), kind_of(caps), {caps, gst_caps_unref}, {}, false});
    read_tags(pad, streams.back());
  }
  file.stop();
  std::stable_sort(streams.begin(), streams.end(),
                   [](const FilmStream& a, const FilmStream& b) { return a.kind < b.kind; });
  return streams;
}

}  // namespace spidar
