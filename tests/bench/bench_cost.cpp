// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Processor time that the element adds to the streaming thread, beyond that of identity: for frames
// that move, and for a picture that stands still.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <map>
#include <string>
#include <vector>

#include <gst/check/gstharness.h>

#include "tests/bench/benchmarks.h"
#include "tests/bench/call_timer.h"
#include "tests/bench/film_frames.h"
#include "tests/bench/gst_pipeline.h"

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

/// Pushes frames through `filter`, paced like a film: all of them to and fro, or the first one
/// again and again. Adds the processor time of each but the first few, ms.
void push_paced(const std::string& filter, GstCaps* caps, const std::vector<GstBuffer*>& frames,
                bool moving, std::vector<double>& thread_ms) {
  GstHarness* const line = gst_harness_new_parse(filter.c_str());
  gst_harness_set_src_caps(line, gst_caps_ref(caps));
  gst_harness_set_drop_buffers(line, TRUE);
  const double start_s = seconds(CLOCK_MONOTONIC);
  for (int n = 0; n < kWarmUp + kFrames; ++n) {
    const size_t period = 2 * (frames.size() - 1);
    const size_t i = moving ? static_cast<size_t>(n) % period : 0;
    GstBuffer* buffer = gst_buffer_copy(frames[std::min(i, period - i)]);  // shares the picture
    set_time(buffer, n, kRate_Hz);
    sleep_until(start_s + static_cast<double>(n) / kRate_Hz);
    const double before_s = seconds(CLOCK_THREAD_CPUTIME_ID);
    gst_harness_push(line, buffer);
    if (n >= kWarmUp) thread_ms.push_back(1e3 * (seconds(CLOCK_THREAD_CPUTIME_ID) - before_s));
  }
  gst_harness_teardown(line);
}

/// A camera that pans over a background with an object in front.
void print(int width, int height) {
  constexpr int kPasses = 3;
  std::vector<GstBuffer*> frames;
  for (const Picture& picture : pan_with_object(width, height)) {
    frames.push_back(i420_buffer(picture));
  }
  GstCaps* caps = gst_caps_new_simple("video/x-raw", "format", G_TYPE_STRING, "I420", "width",
                                      G_TYPE_INT, width, "height", G_TYPE_INT, height, "framerate",
                                      GST_TYPE_FRACTION, kRate_Hz, 1, nullptr);
  std::printf(
      "\n### %dx%d\n\n| frames | element | thread, ms | over identity, ms |\n"
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
