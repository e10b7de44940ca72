// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/paced_push.h"

#include <ctime>
#include <stdexcept>

#include "tests/bench/gst_pipeline.h"

namespace spidar::bench {
namespace {

constexpr int kWarmUp = 10;

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

/// To and fro, so that a short film may go on for long.
size_t frame_index(size_t n, size_t frames) {
  const size_t period = 2 * (frames - 1);
  const size_t i = n % period;
  return i < frames ? i : period - i;
}

/// Which of `frames` is the `n`-th.
size_t shown_frame(Content content, size_t n, size_t frames) {
  if (content == Content::kMoving) return frame_index(n, frames);
  return content == Content::kRepeated ? frame_index(n / 2, frames) : 0;
}

/// A pad that frames are pushed into, and what is behind it.
class Line {
 public:
  Line(const std::string& filter, GstCaps* caps) {
    const std::string description =
        (filter.empty() ? "" : filter + " ! ") + "fakesink async=false sync=false";
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

}  // namespace

PushCost push_paced(const std::string& filter, GstCaps* caps, const std::vector<GstBuffer*>& frames,
                    Content content, int count, int rate_Hz) {
  Line line(filter, caps);
  PushCost cost;
  const double start_s = seconds(CLOCK_MONOTONIC);
  double begin_s = 0, process_s = 0, thread_s = 0;
  for (int n = 0; n < kWarmUp + count; ++n) {
    const size_t shown = shown_frame(content, static_cast<size_t>(n), frames.size());
    GstBuffer* buffer = gst_buffer_copy(frames[shown]);  // shares the picture
    set_time(buffer, n, rate_Hz);
    if (content == Content::kGap) GST_BUFFER_FLAG_SET(buffer, GST_BUFFER_FLAG_GAP);
    sleep_until(start_s + static_cast<double>(n) / rate_Hz);
    if (n == kWarmUp) {
      begin_s = seconds(CLOCK_MONOTONIC);
      process_s = seconds(CLOCK_PROCESS_CPUTIME_ID);
      thread_s = seconds(CLOCK_THREAD_CPUTIME_ID);
    }
    const double wall_before_s = seconds(CLOCK_MONOTONIC);
    const double thread_before_s = seconds(CLOCK_THREAD_CPUTIME_ID);
    line.push(buffer);
    const double thread_after_s = seconds(CLOCK_THREAD_CPUTIME_ID);
    const double wall_after_s = seconds(CLOCK_MONOTONIC);
    if (n < kWarmUp || (content == Content::kRepeated && n % 2 == 0)) continue;
    cost.thread_ms.push_back(1e3 * (thread_after_s - thread_before_s));
    cost.wall_ms.push_back(1e3 * (wall_after_s - wall_before_s));
  }
  const double passed_s = seconds(CLOCK_MONOTONIC) - begin_s;
  cost.others = (seconds(CLOCK_PROCESS_CPUTIME_ID) - process_s -
                 (seconds(CLOCK_THREAD_CPUTIME_ID) - thread_s)) /
                passed_s;
  return cost;
}

}  // namespace spidar::bench
