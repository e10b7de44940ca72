// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/track/track_file.h"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include <gst/gst.h>

namespace spidar {
namespace {

struct Reading {
  TrackInput input;
  TrackFile track;
  std::string problem;
  bool has_caps = false;
};

/// Streaming thread of the pipeline that reads.
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

TrackFile read_track_file(const std::string& path) {
  GError* error = nullptr;
  const std::unique_ptr<GstElement, void (*)(GstElement*)> pipeline(
      gst_parse_launch("filesrc name=source ! decodebin ! audio/x-raw ! fakesink name=out "
                       "signal-handoffs=true sync=false",
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
  gst_object_unref(out);
  GstBus* bus = gst_element_get_bus(pipeline.get());
  gst_element_set_state(pipeline.get(), GST_STATE_PLAYING);
  GstMessage* message = gst_bus_timed_pop_filtered(
      bus, GST_CLOCK_TIME_NONE, static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR));
  gst_object_unref(bus);
  const bool failed = GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR;
  const std::string reason = failed ? text_of(message) : reading.problem;
  gst_message_unref(message);
  gst_element_set_state(pipeline.get(), GST_STATE_NULL);
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
