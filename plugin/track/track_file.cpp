// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/track/track_file.h"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include <gst/gst.h>

#include "plugin/track/film_streams.h"

namespace spidar {
namespace {

struct Reading {
  TrackInput input;
  TrackFile track;
  std::string problem;
  bool has_caps = false;
  bool is_alone = true;  // the file has no other stream
  GstElement* pipeline = nullptr;
  GstElement* decoder = nullptr;
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
    GstElement* taker = reading.decoder;
    if (pad != chosen) {
      taker = gst_element_factory_make("fakesink", nullptr);
      g_object_set(taker, "sync", FALSE, "async", FALSE, nullptr);
      gst_bin_add(GST_BIN(reading.pipeline), taker);
      gst_element_sync_state_with_parent(taker);
    }
    GstPad* sink = gst_element_get_static_pad(taker, "sink");
    gst_pad_link(pad, sink);
    gst_object_unref(sink);
  }
  if (chosen) return;
  GST_ELEMENT_ERROR(parser, STREAM, WRONG_TYPE, ("There is no haptic track in it, and no sound."),
                    ("No stream of sound."));
}

/// Runs in the streaming thread of the pipeline that reads the file.
void take_buffer(GstElement*, GstBuffer* buffer, GstPad* pad, gpointer user) {
  auto& reading = *static_cast<Reading*>(user);
  if (!reading.has_caps) {
    GstCaps* caps = gst_pad_get_current_caps(pad);
    reading.problem = reading.input.set_caps(caps);
    gst_caps_unref(caps);
    reading.has_caps = true;
  }
  if (!reading.problem.empty()) return;
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  reading.input.read(buffer, segment, 1, [&reading](const TrackBlock& block) {
    reading.track.blocks.push_back(block);
    return GST_FLOW_OK;
  });
}

std::string text_of(GstMessage* message) {
  GError* error = nullptr;
  gst_message_parse_error(message, &error, nullptr);
  const std::string text = error->message;
  g_error_free(error);
  return text;
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

TrackFile read_track_file(const std::string& path) {
  GError* error = nullptr;
  const std::unique_ptr<GstElement, void (*)(GstElement*)> pipeline(
      gst_parse_launch("filesrc name=source ! parsebin name=parse decodebin name=decode ! "
                       "audio/x-raw ! fakesink name=out signal-handoffs=true sync=false",
                       &error),
      [](GstElement* element) {
        gst_element_set_state(element, GST_STATE_NULL);
        gst_object_unref(element);
      });
  if (error) {
    const std::string reason = error->message;
    g_error_free(error);
    throw std::runtime_error("haptic tracks cannot be read: " + reason);
  }
  Reading reading;
  GstElement* source = gst_bin_get_by_name(GST_BIN(pipeline.get()), "source");
  g_object_set(source, "location", path.c_str(), nullptr);
  gst_object_unref(source);
  GstElement* out = gst_bin_get_by_name(GST_BIN(pipeline.get()), "out");
  g_signal_connect(out, "handoff", G_CALLBACK(take_buffer), &reading);
  reading.pipeline = pipeline.get();
  reading.decoder = gst_bin_get_by_name(GST_BIN(pipeline.get()), "decode");
  GstElement* parser = gst_bin_get_by_name(GST_BIN(pipeline.get()), "parse");
  const StreamsWatch streams(parser, [&] { choose_stream(reading, parser); });
  gst_object_unref(parser);  // the pipeline has it
  gst_object_unref(out);
  GstBus* bus = gst_element_get_bus(pipeline.get());
  gst_element_set_state(pipeline.get(), GST_STATE_PLAYING);
  GstMessage* message = gst_bus_timed_pop_filtered(
      bus, GST_CLOCK_TIME_NONE, static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR));
  gst_object_unref(bus);
  const bool failed = GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR;
  const std::string reason = failed ? text_of(message) : reading.problem;
  gst_message_unref(message);
  gint64 promised_ns = 0;
  // For a film this is the duration of its longest stream.
  if (reading.is_alone &&
      gst_element_query_duration(pipeline.get(), GST_FORMAT_TIME, &promised_ns)) {
    reading.track.promised_ns = promised_ns;
  }
  gst_element_set_state(pipeline.get(), GST_STATE_NULL);
  gst_object_unref(reading.decoder);
  if (!reason.empty()) throw std::runtime_error(path + ": " + reason);
  std::vector<TrackBlock>& blocks = reading.track.blocks;
  if (blocks.empty()) throw std::runtime_error(path + ": there are no samples in it.");
  const auto earlier = [](const TrackBlock& a, const TrackBlock& b) {
    return a.begin_ns < b.begin_ns;
  };
  std::stable_sort(blocks.begin(), blocks.end(), earlier);
  reading.track.duration_ns = blocks.back().begin_ns + blocks.back().duration_ns;
  reading.track.faults = reading.input.faults();
  return std::move(reading.track);
}

}  // namespace spidar
