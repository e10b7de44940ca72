// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/gst_pipeline.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace spidar::bench {
namespace {

/// Of an error message, which goes.
std::string text_of(GstMessage* message) {
  GError* error = nullptr;
  gst_message_parse_error(message, &error, nullptr);
  const std::string text = error->message;
  g_error_free(error);
  gst_message_unref(message);
  return text;
}

}  // namespace

Pipeline::Pipeline(const std::string& line) {
  GError* error = nullptr;
  pipeline_.reset(gst_parse_launch(line.c_str(), &error));
  if (!error) return;
  const std::string reason = error->message;
  g_error_free(error);
  throw std::runtime_error("GStreamer: " + reason);
}

Pipeline::~Pipeline() {
  if (pipeline_) gst_element_set_state(pipeline_.get(), GST_STATE_NULL);
}

void Pipeline::wait_for_end() {
  GstBus* bus = gst_element_get_bus(pipeline_.get());
  GstMessage* message = gst_bus_timed_pop_filtered(
      bus, GST_CLOCK_TIME_NONE, static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR));
  gst_object_unref(bus);
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) throw std::runtime_error(text_of(message));
  gst_message_unref(message);
}

std::vector<std::vector<double>> read_trace(const std::string& path,
                                            const std::vector<std::string>& columns) {
  std::ifstream trace(path);
  std::vector<std::vector<double>> rows;
  std::vector<size_t> places;
  for (std::string line, field; std::getline(trace, line);) {
    std::vector<std::string> fields;
    std::istringstream rest(line);
    while (std::getline(rest, field, ',')) fields.push_back(field);
    if (places.empty()) {
      for (const std::string& name : columns) {
        const auto found = std::find(fields.begin(), fields.end(), name);
        if (found == fields.end()) throw std::runtime_error(path + " has no column " + name);
        places.push_back(static_cast<size_t>(found - fields.begin()));
      }
      continue;
    }
    if (fields.size() <= *std::max_element(places.begin(), places.end())) continue;
    rows.emplace_back();
    for (const size_t place : places) rows.back().push_back(std::stod(fields[place]));
  }
  return rows;
}

GstBuffer* i420_buffer(const test::Picture& picture) {
  const size_t luma = picture.pixels.size();
  const size_t chroma = luma / 2;
  GstBuffer* buffer = gst_buffer_new_allocate(nullptr, luma + chroma, nullptr);
  gst_buffer_fill(buffer, 0, picture.pixels.data(), luma);
  gst_buffer_memset(buffer, luma, 128, chroma);
  return buffer;
}

void set_time(GstBuffer* buffer, int n, int rate_Hz) {
  const auto rate = static_cast<guint64>(rate_Hz);
  GST_BUFFER_PTS(buffer) = gst_util_uint64_scale(static_cast<guint64>(n), GST_SECOND, rate);
  GST_BUFFER_DURATION(buffer) = GST_SECOND / rate;
}

}  // namespace spidar::bench
