// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/pipelines/stepped_pipeline.h"

#include <iterator>
#include <utility>

#include <gst/base/gstbasesink.h>

#include "plugin/filter/spidar_motion.h"
#include "spidar/loop/haptic_loop.h"

namespace spidar::test {
namespace {

// Any time but zero: a base time of zero would hide one that is missing.
constexpr GstClockTime kStart = 1000 * GST_SECOND;

}  // namespace

SteppedPipeline::SteppedPipeline(const std::string& launch) {
  init_gstreamer();
  clock_ = GST_TEST_CLOCK(gst_test_clock_new_with_start_time(kStart));
  GError* error = nullptr;
  pipeline_ = gst_parse_launch(launch.c_str(), &error);
  if (!pipeline_ || error) g_error("%s", error ? error->message : "no pipeline");
  gst_pipeline_use_clock(GST_PIPELINE(pipeline_), GST_CLOCK(clock_));
  element_ = gst_bin_get_by_name(GST_BIN(pipeline_), "motion");
  sink_ = gst_bin_get_by_name(GST_BIN(pipeline_), "sink");
  inbox_ = std::make_unique<MessageInbox>(pipeline_);
  state_ = &gst_spidar_motion_state(GST_SPIDAR_MOTION(element_));
  state_->feed.output.set_manual([this] { return monotonic_ns(); });
  GstPad* pad = gst_element_get_static_pad(sink_, "sink");
  const auto take = [](GstPad* sink_pad, GstPadProbeInfo* info, gpointer user) {
    GstEvent* event = gst_pad_get_sticky_event(sink_pad, GST_EVENT_SEGMENT, 0);
    const GstSegment* segment;
    gst_event_parse_segment(event, &segment);
    // A sink shows a frame when it comes to its end where it plays backwards.
    const auto* frame = static_cast<GstBuffer*>(info->data);
    const GstClockTime shown_from =
        GST_BUFFER_PTS(frame) + (segment->rate < 0 ? GST_BUFFER_DURATION(frame) : 0);
    static_cast<SteppedPipeline*>(user)->taken_ =
        gst_segment_to_running_time(segment, GST_FORMAT_TIME, shown_from);
    gst_event_unref(event);
    return GST_PAD_PROBE_OK;
  };
  gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_BUFFER, take, this, nullptr);
  gst_object_unref(pad);
}

SteppedPipeline::~SteppedPipeline() {
  gst_element_set_state(pipeline_, GST_STATE_NULL);
  inbox_.reset();
  gst_object_unref(sink_);
  gst_object_unref(element_);
  gst_object_unref(pipeline_);
  gst_object_unref(clock_);
}

int64_t SteppedPipeline::monotonic_ns() const {
  return static_cast<int64_t>(now()) + monotonic_less_clock_ns_;
}

void SteppedPipeline::wait_for_state() {
  if (gst_element_get_state(pipeline_, nullptr, nullptr, GST_CLOCK_TIME_NONE) ==
      GST_STATE_CHANGE_FAILURE) {
    GError* error = nullptr;
    while (GstMessage* message = error ? nullptr : inbox_->pop()) {
      if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) {
        gst_message_parse_error(message, &error, nullptr);
      }
      gst_message_unref(message);
    }
    g_error("the pipeline does not change state: %s", error ? error->message : "no message");
  }
  state_->feed.output.follower().refresh();
}

void SteppedPipeline::set_state(GstState state) {
  gst_element_set_state(pipeline_, state);
  wait_for_state();
}

void SteppedPipeline::play_live() {
  gst_element_set_state(pipeline_, GST_STATE_PLAYING);
}

void SteppedPipeline::seek(GstClockTime position) {
  if (!gst_element_seek_simple(
          pipeline_, GST_FORMAT_TIME,
          static_cast<GstSeekFlags>(GST_SEEK_FLAG_FLUSH | GST_SEEK_FLAG_ACCURATE),
          static_cast<gint64>(position))) {
    g_error("seek refused");
  }
  wait_for_state();
}

void SteppedPipeline::seek(double rate, int flags, GstClockTime start, GstClockTime stop) {
  if (!gst_element_seek(pipeline_, rate, GST_FORMAT_TIME, static_cast<GstSeekFlags>(flags),
                        GST_SEEK_TYPE_SET, static_cast<gint64>(start), GST_SEEK_TYPE_SET,
                        static_cast<gint64>(stop))) {
    g_error("seek refused");
  }
  wait_for_state();
}

void SteppedPipeline::step_frames(guint64 count) {
  gst_element_send_event(sink_, gst_event_new_step(GST_FORMAT_BUFFERS, count, 1, TRUE, FALSE));
  await_message(GST_MESSAGE_STEP_DONE);
  wait_for_state();  // which follows in the same thread when the element has seen it, too
}

void SteppedPipeline::replace_clock(GstClockTime start) {
  set_state(GST_STATE_PAUSED);
  const int64_t monotonic = monotonic_ns();
  gst_object_unref(clock_);
  clock_ = GST_TEST_CLOCK(gst_test_clock_new_with_start_time(start));
  monotonic_less_clock_ns_ = monotonic - static_cast<int64_t>(start);
  gst_pipeline_use_clock(GST_PIPELINE(pipeline_), GST_CLOCK(clock_));
  set_state(GST_STATE_PLAYING);
}

void SteppedPipeline::retime(std::function<GstClockTime(int, GstClockTime)> pts) {
  pts_ = std::move(pts);
  GstPad* pad = gst_element_get_static_pad(element_, "sink");
  const auto probe = [](GstPad*, GstPadProbeInfo* info, gpointer user) {
    auto* self = static_cast<SteppedPipeline*>(user);
    auto* buffer = gst_buffer_make_writable(GST_PAD_PROBE_INFO_BUFFER(info));
    GST_BUFFER_PTS(buffer) = self->pts_(self->frames_++, GST_BUFFER_PTS(buffer));
    GST_PAD_PROBE_INFO_DATA(info) = buffer;
    return GST_PAD_PROBE_OK;
  };
  gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_BUFFER, probe, this, nullptr);
  gst_object_unref(pad);
}

HapticLoop& SteppedPipeline::loop() {
  return state_->feed.output.session()->loop();
}

TickRecord SteppedPipeline::tick() {
  ticked_ = now();
  return watch_.tick(loop(), monotonic_ns());
}

GstClockTime SteppedPipeline::await(guint waiters) {
  GList* waiting = nullptr;
  gst_test_clock_wait_for_multiple_pending_ids(clock_, waiters, &waiting);
  GstClockTime next = GST_CLOCK_TIME_NONE;
  for (GList* i = waiting; i; i = i->next) next = MIN(next, gst_clock_id_get_time(i->data));
  g_list_free_full(waiting, gst_clock_id_unref);
  return next;
}

int64_t SteppedPipeline::half_frame_ns(GstClockTime next) {
  const auto frame = wrenches().find(shown_);
  const bool has_motion = frame != wrenches_.end() && frame != wrenches_.begin() &&
                          !frame->second.stacked().isZero(0) && state_->track.path().empty();
  if (!has_motion) return 0;
  const WrenchBacklog& schedule = state_->feed.schedule;
  const auto shown_ns = static_cast<int64_t>(shown_);
  const auto until_ns = static_cast<int64_t>(next) - static_cast<int64_t>(now());
  const int64_t due_ns = schedule.at_sink_ns(shown_ns) - schedule.skipped_ns();
  if (due_ns != static_cast<int64_t>(running_time()) + until_ns) return 0;
  const auto before_ns = static_cast<int64_t>(std::prev(frame)->first);
  const auto since_ns =
      static_cast<int64_t>(static_cast<double>(shown_ns - before_ns) / schedule.rate_multiplier());
  const int64_t half_ns = since_ns / 2;
  const int64_t passed_ns = static_cast<int64_t>(next) - half_ns - static_cast<int64_t>(ticked_);
  const bool is_gap = since_ns > WrenchTimeline::kLongestHold_ns + 2 * WrenchTimeline::kRamp_ns;
  const bool is_there =
      half_ns <= until_ns && passed_ns >= WrenchTimeline::approach_after(since_ns);
  return is_there && !is_gap ? half_ns : 0;
}

TickRecord SteppedPipeline::step(guint waiters, const std::function<void()>& beside) {
  const GstClockTime next = await(waiters);
  shown_ = taken_;
  early_ns_ = next > now() ? half_frame_ns(next) : 0;
  if (next > now()) gst_test_clock_set_time(clock_, next - static_cast<GstClockTime>(early_ns_));
  state_->feed.output.follower().refresh();
  const TickRecord record = tick();
  if (beside) beside();
  if (early_ns_ > 0) gst_test_clock_set_time(clock_, next);
  gst_clock_id_unref(gst_test_clock_process_next_clock_id(clock_));
  return record;
}

TickRecord SteppedPipeline::idle(GstClockTime duration) {
  TickRecord record;
  for (const GstClockTime end = now() + duration; now() + GST_MSECOND <= end;) {
    gst_test_clock_advance_time(clock_, GST_MSECOND);
    state_->feed.output.follower().refresh();
    record = tick();
  }
  return record;
}

TickRecord SteppedPipeline::stand_still(GstClockTime duration) {
  TickRecord record;
  for (GstClockTime since = 0; since < duration; since += GST_MSECOND) {
    monotonic_less_clock_ns_ += GST_MSECOND;
    if (since % (10 * GST_MSECOND) == 0)
      state_->feed.output.follower().refresh();  // as its thread does
    record = tick();
  }
  return record;
}

GstClockTime SteppedPipeline::running_time() const {
  return now() - gst_element_get_base_time(pipeline_) -
         gst_base_sink_get_latency(GST_BASE_SINK(sink_)) -
         static_cast<GstClockTime>(gst_base_sink_get_ts_offset(GST_BASE_SINK(sink_)));
}

void SteppedPipeline::take(GstMessage* message) {
  messages_ |= GST_MESSAGE_TYPE(message);
  if (gst_message_has_name(message, "spidar-motion")) {
    const MotionMessage motion = parse_motion_message(message);
    // Running time starts again with a seek; earlier frames no longer count.
    if (!wrenches_.empty() && motion.running_time <= wrenches_.rbegin()->first) wrenches_.clear();
    wrenches_[motion.running_time] = motion.wrench;
  }
  gst_message_unref(message);
}

void SteppedPipeline::await_message(GstMessageType type) {
  while (!(messages_ & type)) take(inbox_->await());
  messages_ &= ~static_cast<unsigned>(type);
}

bool SteppedPipeline::has_posted(GstMessageType type) {
  while (GstMessage* const message = inbox_->pop()) take(message);
  return (messages_ & type) != 0;
}

void SteppedPipeline::await_analysed(size_t frames) {
  while (wrenches().size() < frames) take(inbox_->await());
}

void SteppedPipeline::await_end_of_stream() {
  GstPad* pad = gst_element_get_static_pad(element_, "src");
  GstEvent* end = nullptr;
  while (!(end = gst_pad_get_sticky_event(pad, GST_EVENT_EOS, 0))) g_usleep(1000);
  gst_event_unref(end);
  gst_object_unref(pad);
}

const std::map<GstClockTime, Wrench>& SteppedPipeline::wrenches() {
  has_posted(GST_MESSAGE_ELEMENT);
  return wrenches_;
}

void SteppedPipeline::forget_before(GstClockTime running_time) {
  wrenches_.erase(wrenches_.begin(), wrenches_.lower_bound(running_time));
}

}  // namespace spidar::test
