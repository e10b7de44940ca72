// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/track/track_file.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <gst/gst.h>

#include "plugin/track/file_pipeline.h"
#include "plugin/track/film_streams.h"

namespace spidar {
namespace {

struct Reading {
  const FilePipeline& file;
  const bool only_notes;
  TrackInput input;
  TrackFile track;
  std::string problem;
  bool has_caps = false;
  bool is_alone = true;  // the file has no other stream
};

/// Called when all streams of the file are known: decodes the haptic track, or else the first
/// sound, so that the reason for refusing it can be reported. All other streams are ignored.
void choose_stream(Reading& reading, GstElement* parser) {
  reading.is_alone = parser->numsrcpads == 1;
  GstPad* chosen = nullptr;
  StreamKind kind = StreamKind::kOther;
  for (GList* i = parser->srcpads; i; i = i->next) {
    auto* const pad = static_cast<GstPad*>(i->data);
    GstCaps* caps = caps_of(pad);
    const StreamKind this_kind = kind_of(caps);
    gst_caps_unref(caps);
    const bool is_better = this_kind == StreamKind::kHapticTrack
                               ? kind != StreamKind::kHapticTrack
                               : this_kind == StreamKind::kSound && !chosen;
    if (!is_better) continue;
    chosen = pad;
    kind = this_kind;
  }
  for (GList* i = parser->srcpads; i; i = i->next) {
    auto* const pad = static_cast<GstPad*>(i->data);
    GstElement* taker = pad == chosen ? reading.file.find("decode") : reading.file.add_fakesink();
    GstPad* sink = gst_element_get_static_pad(taker, "sink");
    gst_pad_link(pad, sink);
    gst_object_unref(sink);
  }
  if (chosen) return;
  GST_ELEMENT_ERROR(parser, STREAM, WRONG_TYPE, ("There is no haptic track in it, and no sound."),
                    ("No stream of sound."));
}

/// Ends reading before the end of the file.
void give_up(GstPad* pad) {
  GstElement* const element = GST_PAD_PARENT(pad);
  gst_element_post_message(
      element, gst_message_new_application(GST_OBJECT(element), gst_structure_new_empty("enough")));
}

/// Runs in the streaming thread of the pipeline that reads the file.
void take_buffer(GstElement*, GstBuffer* buffer, GstPad* pad, gpointer user) {
  auto& reading = *static_cast<Reading*>(user);
  reading.file.advance();
  if (!reading.has_caps) {
    GstCaps* caps = gst_pad_get_current_caps(pad);
    reading.problem = reading.input.set_caps(caps);
    gst_caps_unref(caps);
    reading.has_caps = true;
    if (reading.only_notes || !reading.problem.empty()) give_up(pad);
  }
  if (reading.only_notes || !reading.problem.empty()) return;
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  reading.input.read(buffer, segment, 1, [&reading, pad](const TrackBlock& block) {
    if (block.begin_ns + block.duration_ns <= TrackFile::kLongest_ns) {
      reading.track.blocks.push_back(block);
      return GST_FLOW_OK;
    }
    reading.problem = "its samples reach to " + std::to_string(block.begin_ns / GST_SECOND) +
                      " s, and a track lasts at most 24 h: is a timestamp in it wrong?";
    give_up(pad);
    return GST_FLOW_EOS;
  });
}

/// All tags that have come to `pad`.
void read_tags(GstPad* pad, TrackNotes& notes) {
  for (guint i = 0; GstEvent* event = gst_pad_get_sticky_event(pad, GST_EVENT_TAG, i); ++i) {
    GstTagList* tags = nullptr;
    gst_event_parse_tag(event, &tags);
    read_notes(tags, notes);
    gst_event_unref(event);
  }
}

/// Sorts what was read. Throws std::runtime_error when there is nothing.
void finish(Reading& reading) {
  std::vector<TrackBlock>& blocks = reading.track.blocks;
  if (blocks.empty()) throw std::runtime_error("there are no samples in it.");
  const auto earlier = [](const TrackBlock& a, const TrackBlock& b) {
    return a.begin_ns < b.begin_ns;
  };
  std::stable_sort(blocks.begin(), blocks.end(), earlier);
  reading.track.duration_ns = blocks.back().begin_ns + blocks.back().duration_ns;
  reading.track.faults = reading.input.faults();
}

TrackFile read(const std::string& path, bool only_notes, const std::atomic<bool>* stopped) {
  const FilePipeline file(
      "filesrc name=source ! parsebin name=parse decodebin name=decode ! audio/x-raw ! "
      "fakesink name=out signal-handoffs=true sync=false",
      path, stopped);
  Reading reading{file, only_notes, {}, {}, {}};
  GstElement* const out = file.find("out");
  GstElement* const parser = file.find("parse");
  g_signal_connect(out, "handoff", G_CALLBACK(take_buffer), &reading);
  const StreamsWatch streams(parser, [&] { choose_stream(reading, parser); });
  struct Stop {
    const FilePipeline& file;
    ~Stop() { file.stop(); }
  } const stop{file};  // before what its streaming threads use
  file.play_until(GST_MESSAGE_APPLICATION);
  GstPad* pad = gst_element_get_static_pad(out, "sink");
  read_tags(pad, reading.track.notes);
  gst_object_unref(pad);
  gint64 promised_ns = 0;
  // For a film this is the duration of its longest stream.
  if (reading.is_alone &&
      gst_element_query_duration(file.pipeline(), GST_FORMAT_TIME, &promised_ns)) {
    reading.track.promised_ns = promised_ns;
  }
  file.stop();
  if (!reading.problem.empty()) throw std::runtime_error(reading.problem);
  if (!only_notes) finish(reading);
  return std::move(reading.track);
}

}  // namespace

std::string TrackFile::missing() const {
  // Containers round durations, to milliseconds or samples.
  if (promised_ns <= duration_ns + GST_MSECOND) return {};
  gchar* const text = g_strdup_printf("it is cut off: %.3f s of %.3f s are there",
                                      1e-9 * static_cast<double>(duration_ns),
                                      1e-9 * static_cast<double>(promised_ns));
  const std::string result = text;
  g_free(text);
  return result;
}

TrackFile read_track_file(const std::string& path, const std::atomic<bool>* stopped) {
  try {
    return read(path, false, stopped);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
}

TrackNotes read_track_notes(const std::string& path) {
  try {
    return read(path, true, nullptr).notes;
  } catch (const std::runtime_error&) {
    return {};
  }
}

}  // namespace spidar
