// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/pipelines/launched.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/message_inbox.h"
#include "tests/support/tick_watch.h"

namespace spidar::test {

void take(Outcome& outcome, GstMessage* message) {
  GError* error = nullptr;
  switch (GST_MESSAGE_TYPE(message)) {
    case GST_MESSAGE_EOS:
      outcome.eos = true;
      break;
    case GST_MESSAGE_ERROR:
      gst_message_parse_error(message, &error, nullptr);
      outcome.error = error->message;
      break;
    case GST_MESSAGE_WARNING:
      gst_message_parse_warning(message, &error, nullptr);
      outcome.warnings.emplace_back(error->message);
      break;
    case GST_MESSAGE_NEW_CLOCK: {
      GstClock* clock = nullptr;
      gst_message_parse_new_clock(message, &clock);
      outcome.clock = G_OBJECT_TYPE_NAME(clock);
      break;
    }
    case GST_MESSAGE_ELEMENT:
      if (gst_message_has_name(message, "spidar-motion")) {
        double x = 0, y = 0;
        gst_structure_get(gst_message_get_structure(message), "force-x", G_TYPE_DOUBLE, &x,
                          "force-y", G_TYPE_DOUBLE, &y, nullptr);
        outcome.largest_force_N = std::max(outcome.largest_force_N, std::hypot(x, y));
        ++outcome.motions;
      }
      break;
    default:
      break;
  }
  g_clear_error(&error);
}

Traces::Traces(GstElement* bin) {
  g_signal_connect(bin, "deep-element-added", G_CALLBACK(added), this);
  GstIterator* all = gst_bin_iterate_recurse(GST_BIN(bin));
  gst_iterator_foreach(
      all,
      [](const GValue* item, gpointer self) {
        static_cast<Traces*>(self)->record(static_cast<GstElement*>(g_value_get_object(item)));
      },
      this);
  gst_iterator_free(all);
}

Traces::~Traces() {
  for (const std::string& path : paths_) TickWatch().see_trace(path);
}

void Traces::record(GstElement* element) {
  const std::string type = G_OBJECT_TYPE_NAME(element);
  if (type != "GstSpidarMotion" && type != "GstSpidarSink") return;
  const std::lock_guard<std::mutex> lock(mutex_);
  paths_.push_back((folder_.path / std::to_string(paths_.size())).string());
  g_object_set(element, "haptic-trace", paths_.back().c_str(), nullptr);
}

Outcome run_to_end(GstElement* pipeline, int frames) {
  Outcome outcome;
  const Traces traces(pipeline);
  MessageInbox inbox(pipeline);
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  while (!outcome.eos && outcome.error.empty() && (frames == 0 || outcome.motions < frames)) {
    GstMessage* message = inbox.await();
    take(outcome, message);
    gst_message_unref(message);
  }
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(pipeline);
  return outcome;
}

Outcome launch(const std::string& line, int frames) {
  SCOPED_TRACE(line);
  GError* error = nullptr;
  GstElement* pipeline = gst_parse_launch(line.c_str(), &error);
  if (error) {  // a part of it may be there
    ADD_FAILURE() << error->message;
    g_clear_error(&error);
    if (pipeline) gst_object_unref(gst_object_ref_sink(pipeline));
    return {};
  }
  return run_to_end(pipeline, frames);
}

}  // namespace spidar::test
