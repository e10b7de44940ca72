// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tracks/file_pipeline.h"

#include <filesystem>
#include <stdexcept>

namespace spidar {
namespace {

/// How often a thread that reads looks whether it is to stop.
constexpr GstClockTime kLook = 20 * GST_MSECOND;

void stop_and_unref(GstElement* pipeline) {
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(pipeline);
}

std::string text_of(GstMessage* message) {
  GError* error = nullptr;
  gst_message_parse_error(message, &error, nullptr);
  const std::string text = error->message;
  g_error_free(error);
  return text;
}

}  // namespace

FilePipeline::FilePipeline(const std::string& line, const std::string& path,
                           const std::atomic<bool>* stopped)
    : stopped_(stopped), pipeline_(nullptr, stop_and_unref) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (!std::filesystem::exists(status)) throw std::runtime_error("there is no such file");
  if (!std::filesystem::is_regular_file(status))
    throw std::runtime_error("it is not a regular file");
  GError* error = nullptr;
  pipeline_.reset(gst_parse_launch(line.c_str(), &error));
  if (error) {
    const std::string reason = error->message;
    g_error_free(error);
    throw std::runtime_error(reason);
  }
  g_object_set(find("source"), "location", path.c_str(), nullptr);
}

GstElement* FilePipeline::find(const char* name) const {
  GstElement* element = gst_bin_get_by_name(GST_BIN(pipeline_.get()), name);
  gst_object_unref(element);
  return element;
}

GstElement* FilePipeline::add_fakesink() const {
  GstElement* sink = gst_element_factory_make("fakesink", nullptr);
  g_object_set(sink, "sync", FALSE, "async", FALSE, nullptr);
  gst_bin_add(GST_BIN(pipeline_.get()), sink);
  gst_element_sync_state_with_parent(sink);
  return sink;
}

void FilePipeline::pause() const {
  gst_element_set_state(pipeline_.get(), GST_STATE_PAUSED);
  const Bus messages = bus();
  gst_bus_set_flushing(messages.get(), TRUE);
  gst_bus_set_flushing(messages.get(), FALSE);
}

GstMessageType FilePipeline::play_until(GstMessageType awaited, GstClockTime limit) const {
  const auto types = static_cast<GstMessageType>(awaited | GST_MESSAGE_EOS | GST_MESSAGE_ERROR);
  const Bus messages = bus();
  bool failed =
      gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING) == GST_STATE_CHANGE_FAILURE;
  uint64_t read = read_;
  GstClockTime silent = 0;
  for (GstClockTime waited = 0; waited < limit; waited += kLook) {
    GstMessage* message = gst_bus_timed_pop_filtered(messages.get(), kLook, types);
    if (message) {
      const GstMessageType type = GST_MESSAGE_TYPE(message);
      const std::string reason = type == GST_MESSAGE_ERROR ? text_of(message) : std::string();
      gst_message_unref(message);
      if (type == GST_MESSAGE_ERROR) throw std::runtime_error(reason);
      return type;
    }
    if (failed) throw std::runtime_error("GStreamer cannot read it, and does not say why");
    silent = read == read_ ? silent + kLook : 0;
    read = read_;
    if (silent >= kLongestSilence) {
      throw std::runtime_error("there is nothing more to read, but no end: it may be damaged");
    }
    if (stopped_ && *stopped_) throw std::runtime_error("reading was stopped");
  }
  return GST_MESSAGE_UNKNOWN;
}

}  // namespace spidar
