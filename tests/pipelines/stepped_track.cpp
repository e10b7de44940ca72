// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/pipelines/stepped_track.h"

#include <utility>

#include "plugin/tracks/track_elements.h"
#include "plugin/tracks/track_tags.h"
#include "tests/support/element_harness.h"

namespace spidar::test {
namespace {

// Any time will do that is not zero: a base time of zero would hide a forgotten one.
constexpr GstClockTime kTrackStart = 1000 * GST_SECOND;

int64_t now_of(GstTestClock* clock) {
  return static_cast<int64_t>(gst_clock_get_time(GST_CLOCK(clock)));
}

}  // namespace

SteppedTrack::SteppedTrack(const std::string& properties, const std::string& caps) {
  init_gstreamer();
  GST_ELEMENT_REGISTER(spidarsink, nullptr);
  clock_ = GST_TEST_CLOCK(gst_test_clock_new_with_start_time(kTrackStart));
  GError* error = nullptr;
  sink_ = gst_parse_launch(("spidarsink " + properties).c_str(), &error);
  if (!sink_ || error) g_error("%s", error ? error->message : "no sink");
  gst_object_ref_sink(sink_);
  pipeline_ = gst_pipeline_new(nullptr);
  gst_bin_add(GST_BIN(pipeline_), sink_);
  gst_pipeline_use_clock(GST_PIPELINE(pipeline_), GST_CLOCK(clock_));
  source_ = gst_pad_new("src", GST_PAD_SRC);
  gst_pad_set_active(source_, TRUE);
  GstPad* pad = gst_element_get_static_pad(sink_, "sink");
  gst_pad_link(source_, pad);
  gst_object_unref(pad);
  stream_.push_back(GST_MINI_OBJECT_CAST(gst_event_new_stream_start("track")));
  GstCaps* parsed = gst_caps_from_string(caps.c_str());
  stream_.push_back(GST_MINI_OBJECT_CAST(gst_event_new_caps(parsed)));
  gst_caps_unref(parsed);
  stream_.push_back(GST_MINI_OBJECT_CAST(gst_event_new_tag(tracks::tags())));
  begin_segment(1, 0, GST_CLOCK_TIME_NONE);
  bus_ = gst_element_get_bus(pipeline_);
  output_ = &gst_spidar_sink_output(GST_SPIDAR_SINK(sink_));
  output_->set_manual([this] { return now_of(clock_); });
}

SteppedTrack::~SteppedTrack() {
  gst_element_set_state(pipeline_, GST_STATE_NULL);
  if (sender_.joinable()) sender_.join();
  for (GstMiniObject* item : stream_) gst_mini_object_unref(item);
  gst_object_unref(bus_);
  gst_object_unref(source_);
  gst_object_unref(sink_);
  gst_object_unref(pipeline_);
  gst_object_unref(clock_);
}

void SteppedTrack::push_bytes(const void* bytes, size_t size, GstClockTime pts,
                              GstClockTime duration) {
  GstBuffer* buffer = gst_buffer_new_memdup(bytes, size);
  GST_BUFFER_PTS(buffer) = pts;
  GST_BUFFER_DURATION(buffer) = duration;
  stream_.push_back(GST_MINI_OBJECT_CAST(buffer));
}

void SteppedTrack::begin_segment(double rate, GstClockTime start, GstClockTime stop,
                                 GstClockTime base) {
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  segment.rate = rate;
  segment.start = segment.time = start;
  segment.stop = stop;
  segment.base = base;
  segment.position = rate > 0 ? start : stop;
  stream_.push_back(GST_MINI_OBJECT_CAST(gst_event_new_segment(&segment)));
}

void SteppedTrack::send() {
  // Pads take nothing below PAUSED.
  gst_element_set_state(pipeline_, GST_STATE_PAUSED);
  sender_ = std::thread([this, stream = std::exchange(stream_, {})] {
    for (GstMiniObject* item : stream) {
      if (GST_IS_BUFFER(item)) {
        gst_pad_push(source_, GST_BUFFER_CAST(item));
      } else {
        gst_pad_push_event(source_, GST_EVENT_CAST(item));
      }
    }
  });
}

void SteppedTrack::set_state(GstState state) {
  if (!sender_.joinable()) send();
  const GstStateChangeReturn result = gst_element_set_state(pipeline_, state);
  if (result == GST_STATE_CHANGE_ASYNC) {
    gst_element_get_state(pipeline_, nullptr, nullptr, 60 * GST_SECOND);
  }
  output_->follower().refresh();
}

void SteppedTrack::continue_with(GstClockTime start, GstClockTime base) {
  begin_segment(1, start, GST_CLOCK_TIME_NONE, base);
}

void SteppedTrack::flush() {
  gst_pad_push_event(source_, gst_event_new_flush_start());
  sender_.join();
  for (GstMiniObject* item : std::exchange(stream_, {})) gst_mini_object_unref(item);
  flushing_ = true;
}

void SteppedTrack::seek(double rate, GstClockTime start, GstClockTime stop) {
  flush();
  flushing_ = false;
  gst_pad_push_event(source_, gst_event_new_flush_stop(TRUE));
  begin_segment(rate, start, stop);
}

bool SteppedTrack::ended() {
  while (GstMessage* message = gst_bus_pop(bus_)) {
    GError* error = nullptr;
    if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_EOS) ended_ = true;
    if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_WARNING) {
      gst_message_parse_warning(message, &error, nullptr);
    } else if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) {
      gst_message_parse_error(message, &error, nullptr);
      failed_ = true;
    }
    if (gst_message_has_name(message, "spidar-motion")) {
      motions_.push_back(parse_motion_message(message));
    }
    if (error) warnings_.emplace_back(error->message);
    g_clear_error(&error);
    gst_message_unref(message);
  }
  return ended_;
}

std::vector<MotionMessage> SteppedTrack::motions() {
  ended();
  return std::exchange(motions_, {});
}

std::vector<std::string> SteppedTrack::warnings() {
  ended();
  return std::exchange(warnings_, {});
}

void SteppedTrack::let_through() {
  const bool plays = GST_STATE(pipeline_) == GST_STATE_PLAYING;
  const GstClockTime now = gst_clock_get_time(GST_CLOCK(clock_));
  while (plays && !ended() && !failed_ && !flushing_) {
    GstClockID pending = nullptr;
    // In real time: only so long does a test look for what happens in place of waiting.
    if (!gst_test_clock_timed_wait_for_multiple_pending_ids(clock_, 1, 10, nullptr)) continue;
    gst_test_clock_wait_for_next_pending_id(clock_, &pending);
    const GstClockTime due = gst_clock_id_get_time(pending);
    gst_clock_id_unref(pending);
    if (due > now) return;
    GstClockID done = gst_test_clock_process_next_clock_id(clock_);
    if (done) gst_clock_id_unref(done);
  }
}

TickRecord SteppedTrack::tick() {
  let_through();
  gst_test_clock_advance_time(clock_, GST_MSECOND);
  let_through();
  output_->follower().refresh();
  return watch_.tick(output_->session()->loop(), now_of(clock_));
}

TickRecord SteppedTrack::run(int ticks) {
  TickRecord record;
  for (int i = 0; i < ticks; ++i) record = tick();
  return record;
}

guint64 SteppedTrack::stat(const char* name) const {
  GstStructure* stats = nullptr;
  guint64 value = 0;
  g_object_get(sink_, "stats", &stats, nullptr);
  if (!gst_structure_get_uint64(stats, name, &value)) g_error("no %s in stats", name);
  gst_structure_free(stats);
  return value;
}

}  // namespace spidar::test
