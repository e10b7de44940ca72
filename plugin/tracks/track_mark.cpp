// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tracks/track_mark.h"

#include <sstream>

#include "core/track/track_format.h"

namespace spidar {
namespace {

bool has_line(const std::string& text, const std::string& wanted) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line == wanted) return true;
  }
  return false;
}

}  // namespace

const char* const kTrackMark = "HAPTIC_FULL_SCALE=10 N, 1 N m";

bool is_marked(const GstTagList* tags) {
  if (gst_tag_list_get_scope(tags) != GST_TAG_SCOPE_STREAM) return false;
  for (const char* tag : {GST_TAG_COMMENT, GST_TAG_EXTENDED_COMMENT}) {
    const guint count = gst_tag_list_get_tag_size(tags, tag);
    for (guint i = 0; i < count; ++i) {
      const gchar* text = nullptr;
      if (gst_tag_list_peek_string_index(tags, tag, i, &text) && has_line(text, kTrackMark))
        return true;
    }
  }
  return false;
}

void follow_mark(GstEvent* event, bool& marked) {
  if (GST_EVENT_TYPE(event) == GST_EVENT_STREAM_START) marked = false;
  if (GST_EVENT_TYPE(event) != GST_EVENT_TAG) return;
  GstTagList* tags = nullptr;
  gst_event_parse_tag(event, &tags);
  marked = marked || is_marked(tags);
}

bool is_marked(GstPad* pad) {
  bool marked = false;
  for (guint i = 0; GstEvent* event = gst_pad_get_sticky_event(pad, GST_EVENT_TAG, i); ++i) {
    follow_mark(event, marked);
    gst_event_unref(event);
  }
  return marked;
}

bool has_form_of_track(const GstCaps* caps) {
  int channels = 0, rate_Hz = 0;
  const GstStructure* structure = gst_caps_get_structure(caps, 0);
  gst_structure_get_int(structure, "channels", &channels);
  gst_structure_get_int(structure, "rate", &rate_Hz);
  return channels == static_cast<int>(kTrackChannels) && rate_Hz == kTrackRate_Hz;
}

std::string how_to_mark() {
  return std::string("ffmpeg -i FILE -metadata comment=\"") + kTrackMark +
         "\" -c:a pcm_f32le MARKED.wav";
}

}  // namespace spidar
