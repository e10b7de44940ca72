// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/skew/clip.h"

#include <stdexcept>

#include <gst/gst.h>

namespace spidar::bench {

std::string missing_element() {
  for (const char* const needed : {"videotestsrc", "audiotestsrc", "vp8enc", "vp8dec", "avimux",
                                   "avidemux", "wavparse", "playbin", "playbin3", "appsrc"}) {
    GstElementFactory* const factory = gst_element_factory_find(needed);
    if (!factory) return needed;
    gst_object_unref(factory);
  }
  return "";
}

namespace {

/// Runs a pipeline that makes a file.
void make(const std::string& launch) {
  GError* error = nullptr;
  GstElement* const pipeline = gst_parse_launch(launch.c_str(), &error);
  if (!error) {
    gst_element_set_state(pipeline, GST_STATE_PLAYING);
    GstBus* const bus = gst_element_get_bus(pipeline);
    GstMessage* const end = gst_bus_timed_pop_filtered(
        bus, GST_CLOCK_TIME_NONE, static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR));
    if (GST_MESSAGE_TYPE(end) == GST_MESSAGE_ERROR) {
      gst_message_parse_error(end, &error, nullptr);
    }
    gst_message_unref(end);
    gst_object_unref(bus);
    gst_element_set_state(pipeline, GST_STATE_NULL);
  }
  if (pipeline) gst_object_unref(pipeline);
  if (!error) return;
  const std::string text = error->message;
  g_error_free(error);
  throw std::runtime_error("the clip cannot be made: " + text);
}

}  // namespace

void make_clip(const std::string& path, int seconds) {
  constexpr int kFrames_s = 30;
  constexpr int kBlocks_s = 50;
  const std::string launch =
      "avimux name=mux ! filesink location=\"" + path +
      "\" videotestsrc pattern=ball num-buffers=" + std::to_string(seconds * kFrames_s) +
      " ! video/x-raw,format=I420,width=1280,height=720,framerate=30000/1001 "
      "! vp8enc deadline=1 cpu-used=16 keyframe-max-dist=15 threads=2 ! queue ! mux. "
      "audiotestsrc samplesperbuffer=960 num-buffers=" +
      std::to_string(seconds * kBlocks_s) +
      " ! audio/x-raw,format=S16LE,rate=48000,channels=2 ! queue ! mux.";
  make(launch);
}

std::string track_of(const std::string& clip) {
  return clip + ".wav";
}

void make_track(const std::string& path, int seconds) {
  make("audiotestsrc freq=1 volume=0.1 samplesperbuffer=40 num-buffers=" +
       std::to_string(seconds * 25) +
       " ! audio/x-raw,format=F32LE,rate=1000,channels=6,channel-mask=(bitmask)0x3f ! wavenc ! "
       "filesink location=\"" +
       path + "\"");
}

}  // namespace spidar::bench
