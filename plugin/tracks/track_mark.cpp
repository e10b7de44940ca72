// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tracks/track_mark.h"

#include <sstream>
#include <utility>

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
      if (gst_tag_list_peek_string_index(tags, tag, i, &text) && has_line(text, kTrackMark)) {
        return true;
      }
    }
  }
  return false;
}

void StreamMark::follow(GstEvent* event) {
  GstTagList* tags = nullptr;
  switch (GST_EVENT_TYPE(event)) {
    case GST_EVENT_STREAM_START:
      if (std::exchange(has_caps_, false)) is_set_ = false;
      break;
    case GST_EVENT_CAPS:
      has_caps_ = true;
      break;
    case GST_EVENT_TAG:
      gst_event_parse_tag(event, &tags);
      is_set_ = is_set_ || is_marked(tags);
      break;
    default:
      break;
  }
}

bool is_marked(GstPad* pad) {
  StreamMark mark;
  for (guint i = 0; GstEvent* event = gst_pad_get_sticky_event(pad, GST_EVENT_TAG, i); ++i) {
    mark.follow(event);
    gst_event_unref(event);
  }
  return mark.is_set();
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
