// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Processor time that the element adds to the streaming thread, beyond that of identity: for frames
// that move, and for a picture that stands still.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <gst/gst.h>

#include "tests/bench/benchmarks.h"
#include "tests/bench/call_timer.h"
#include "tests/bench/film_frames.h"
#include "tests/bench/gst_pipeline.h"
#include "tests/support/film_studio.h"

namespace {

using namespace spidar::bench;
using spidar::test::Picture;

constexpr int kRate_Hz = 60;
constexpr int kWarmUp = 10;
constexpr int kFrames = 60;

double seconds(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

void sleep_until(double monotonic_s) {
  timespec t{};
  t.tv_sec = static_cast<time_t>(monotonic_s);
  t.tv_nsec = static_cast<long>(1e9 * (monotonic_s - static_cast<double>(t.tv_sec)));
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr);
}

/// A pad that frames are pushed into, and what is behind it.
class Line {
 public:
  Line(const std::string& filter, GstCaps* caps) {
    const std::string description = filter + " ! fakesink async=false sync=false";
    GError* error = nullptr;
    GstElement* bin = gst_parse_bin_from_description(description.c_str(), TRUE, &error);
    if (error) {
      const std::string reason = error->message;
      g_error_free(error);
      throw std::runtime_error(description + ": " + reason);
    }
    pipeline_.reset(gst_pipeline_new(nullptr));
    gst_bin_add(GST_BIN(pipeline_.get()), bin);
    GstBus* bus = gst_element_get_bus(pipeline_.get());
    // An application takes messages as they come; here nobody does.
    gst_bus_set_flushing(bus, TRUE);
    gst_object_unref(bus);
    GstPad* sink = gst_element_get_static_pad(bin, "sink");
    source_ = gst_pad_new("src", GST_PAD_SRC);
    gst_pad_set_active(source_, TRUE);
    const GstPadLinkReturn linked = gst_pad_link_full(source_, sink, GST_PAD_LINK_CHECK_NOTHING);
    gst_object_unref(sink);
    if (linked != GST_PAD_LINK_OK ||
        gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING) == GST_STATE_CHANGE_FAILURE) {
      throw std::runtime_error(description + ": does not play");
    }
    GstSegment segment;
    gst_segment_init(&segment, GST_FORMAT_TIME);
    gst_pad_push_event(source_, gst_event_new_stream_start("film"));
    gst_pad_push_event(source_, gst_event_new_caps(caps));
    gst_pad_push_event(source_, gst_event_new_segment(&segment));
  }
  ~Line() {
    gst_element_set_state(pipeline_.get(), GST_STATE_NULL);
    gst_object_unref(source_);
  }
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;

  void push(GstBuffer* buffer) {
    if (gst_pad_push(source_, buffer) != GST_FLOW_OK) {
      throw std::runtime_error("a frame was refused");
    }
  }

 private:
  Element pipeline_;
  GstPad* source_ = nullptr;
};

/// Pushes frames through `filter`, paced like a film: all of them to and fro, or the first one
/// again and again. Adds the processor time of each but the first few, ms.
void push_paced(const std::string& filter, GstCaps* caps, const std::vector<GstBuffer*>& frames,
                bool moving, std::vector<double>& thread_ms) {
  Line line(filter, caps);
  const double start_s = seconds(CLOCK_MONOTONIC);
  for (int n = 0; n < kWarmUp + kFrames; ++n) {
    const size_t period = 2 * (frames.size() - 1);
    const size_t i = moving ? static_cast<size_t>(n) % period : 0;
    GstBuffer* buffer = gst_buffer_copy(frames[std::min(i, period - i)]);  // shares the picture
    set_time(buffer, n, kRate_Hz);
    sleep_until(start_s + static_cast<double>(n) / kRate_Hz);
    const double before_s = seconds(CLOCK_THREAD_CPUTIME_ID);
    line.push(buffer);
    if (n >= kWarmUp) thread_ms.push_back(1e3 * (seconds(CLOCK_THREAD_CPUTIME_ID) - before_s));
  }
}

/// A camera that pans over a background with an object in front.
void print(int width, int height) {
  constexpr int kPasses = 3;
  spidar::test::FilmStudio studio(width, height, 1);
  spidar::test::Film film = studio.pan_with_object();
  std::vector<GstBuffer*> frames;
  for (const Picture& picture : draw_all(film, spidar::test::kFilmFrames)) {
    frames.push_back(i420_buffer(picture));
  }
  GstCaps* caps = gst_caps_new_simple("video/x-raw", "format", G_TYPE_STRING, "I420", "width",
                                      G_TYPE_INT, width, "height", G_TYPE_INT, height, "framerate",
                                      GST_TYPE_FRACTION, kRate_Hz, 1, nullptr);
  std::printf(
      "\n### %dx%d\n\n| frames | source ! … ! fakesink | thread, ms | over identity, ms |\n"
      "|---|---|---|---|\n",
      width, height);
  for (const bool moving : {true, false}) {
    std::map<std::string, std::vector<double>> thread_ms;
    for (int pass = 0; pass < kPasses; ++pass) {  // in turns: what disturbs meets all of them
      for (const char* filter : {"identity", "spidarmotion device=none", "spidarmotion"}) {
        push_paced(filter, caps, frames, moving, thread_ms[filter]);
      }
    }
    const double identity_ms = quantile(thread_ms["identity"], 0.5);
    for (const auto& [filter, ms] : thread_ms) {
      std::printf("| %s | %s | %.3f | %.3f |\n", moving ? "moving" : "still", filter.c_str(),
                  quantile(ms, 0.5), quantile(ms, 0.5) - identity_ms);
    }
  }
  for (GstBuffer* frame : frames) gst_buffer_unref(frame);
  gst_caps_unref(caps);
}

}  // namespace

int spidar::bench::cost(int, char**) {
  print(1920, 1080);
  print(3840, 2160);
  return 0;
}
