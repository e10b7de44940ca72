// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/films/stream_content.h"

#include <sstream>
#include <utility>

#include "core/track/track_format.h"
#include "plugin/gobject/ref.h"
#include "plugin/timing/frame_pacer.h"

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

bool is_marked_track(const GstTagList* tags) {
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

void TrackMark::update(GstEvent* event) {
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
      is_set_ = is_set_ || is_marked_track(tags);
      break;
    default:
      break;
  }
}

bool is_marked_track(GstPad* pad) {
  TrackMark mark;
  for (guint i = 0; GstEvent* event = gst_pad_get_sticky_event(pad, GST_EVENT_TAG, i); ++i) {
    mark.update(event);
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

StreamContent content_of(const GstCaps* caps) {
  if (!caps || gst_caps_is_empty(caps) || gst_caps_is_any(caps)) return StreamContent::kOther;
  const GstStructure* structure = gst_caps_get_structure(caps, 0);
  const std::string name = gst_structure_get_name(structure);
  if (name.rfind("video/", 0) == 0 || name.rfind("image/", 0) == 0) return StreamContent::kVideo;
  for (const char* begin : {"text/", "subtitle/", "subpicture/", "application/x-subtitle",
                            "application/x-ssa", "application/x-ass", "application/x-usf"}) {
    if (name.rfind(begin, 0) == 0) return StreamContent::kSubtitles;
  }
  if (name.rfind("audio/", 0) != 0) return StreamContent::kOther;
  return has_form_of_track(caps) ? StreamContent::kHapticTrack : StreamContent::kSound;
}

StreamContent content_of(GstPad* pad) {
  const Ref<GstCaps> caps(caps_of(pad));
  const StreamContent content = content_of(caps.get());
  return content == StreamContent::kSound && is_marked_track(pad) ? StreamContent::kHapticTrack
                                                                  : content;
}

bool is_picture(const GstCaps* caps) {
  if (!caps || gst_caps_is_empty(caps) || gst_caps_is_any(caps)) return false;
  return g_str_has_prefix(gst_structure_get_name(gst_caps_get_structure(caps, 0)), "image/");
}

std::string why_missing(GstElement* bin) {
  g_autoptr(GstIterator) demuxers =
      gst_bin_iterate_all_by_element_factory_name(GST_BIN(bin), "qtdemux");
  g_auto(GValue) demuxer = G_VALUE_INIT;
  if (gst_iterator_next(demuxers, &demuxer) != GST_ITERATOR_OK) return {};
  return " (GStreamer leaves out what is shorter than a fifth of an MP4 or MOV film; in a copy "
         "made "
         "by ffmpeg -i FILM -c copy FILM.mkv it is there)";
}

GstClockTime stream_time_of(GstPad* pad, GstBuffer* buffer) {
  const Ref<GstEvent> event(gst_pad_get_sticky_event(pad, GST_EVENT_SEGMENT, 0));
  if (!event) return GST_CLOCK_TIME_NONE;
  const GstSegment* segment = nullptr;
  gst_event_parse_segment(event.get(), &segment);
  return stream_time_of(*segment, GST_BUFFER_PTS(buffer));
}

GstCaps* caps_of(GstPad* pad) {
  GstCaps* caps = gst_pad_get_current_caps(pad);
  // Caps reach the pad of a parsebin with the first data, but its parser has them earlier.
  const Ref<GstPad> target(
      !caps && GST_IS_GHOST_PAD(pad) ? gst_ghost_pad_get_target(GST_GHOST_PAD(pad)) : nullptr);
  if (target) caps = gst_pad_get_current_caps(target.get());
  return caps ? caps : gst_pad_query_caps(pad, nullptr);
}

}  // namespace spidar
