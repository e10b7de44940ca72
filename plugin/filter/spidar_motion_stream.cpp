// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Frames and events that pass through the element.
#include <chrono>
#include <string>
#include <utility>

#include "plugin/filter/analysis_permit.h"
#include "plugin/filter/motion_state.h"
#include "plugin/frame/frame_fields.h"
#include "plugin/gobject/bus_messages.h"
#include "plugin/timing/frame_pacer.h"
#include "plugin/tracks/sidecar.h"

#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT gst_spidar_motion_debug

using spidar::FrameReport;
using spidar::Pointer;
using spidar::filter::AnalysisPermit;
using spidar::filter::MotionState;

static GstBaseTransformClass* parent_class() {
  return GST_BASE_TRANSFORM_CLASS(g_type_class_peek(GST_TYPE_VIDEO_FILTER));
}

/// Copies the settings for the frame, so that they stay the same while it is processed.
static void gst_spidar_motion_before_transform(GstBaseTransform* trans, GstBuffer* buffer) {
  GstSpidarMotionFilter* self = GST_SPIDAR_MOTION(trans);
  MotionState& state = *self->state;
  const GstClockTime time = spidar::stream_time_of(trans->segment, GST_BUFFER_PTS(buffer));
  if (GST_CLOCK_TIME_IS_VALID(time)) gst_object_sync_values(GST_OBJECT(trans), time);
  const bool has_new_rules = state.choice.must_read();
  std::string feel;
  GST_OBJECT_LOCK(self);
  state.frame_settings = state.settings;
  if (has_new_rules) feel = state.settings.feel;
  GST_OBJECT_UNLOCK(self);
  if (has_new_rules) state.choice.read(feel, trans->sinkpad);
}

/// How long a stream waits for its track to be opened; frames that come before are analysed.
static constexpr std::chrono::seconds kLongestWait{3};
static void begin_to_load_track(GstSpidarMotionFilter* self) {
  MotionState& state = *self->state;
  GST_OBJECT_LOCK(self);
  const std::string track = state.settings.track;
  GST_OBJECT_UNLOCK(self);
  const std::string film = spidar::film_of(GST_BASE_TRANSFORM_SINK_PAD(self));
  state.choice.begin_stream(film);
  state.display.begin_stream(film);
  state.track.begin_stream(track, film);
}

/// Adds the present pointer and choice to the settings of the frame.
static void complete_settings(MotionState& state, const GstVideoFrame& frame) {
  spidar::FrameSettings& settings = state.frame_settings;
  if (settings.pointer == Pointer::Kind::kGrip) {
    settings.analyzer.pointer =
        spidar::filter::grip_position(state.feed.output).value_or(settings.analyzer.pointer);
    state.warnings.check_pointer(state.feed.output.session());
  }
  state.choice.complete(frame, state.orientation.turn(), settings);
}

static void log_frame(GstSpidarMotionFilter* self, const FrameReport& report, GstBuffer* buffer) {
  if (!report.has_wrench()) {
    GST_DEBUG_OBJECT(self, "frame at %" GST_TIME_FORMAT " is not analysed: %s",
                     GST_TIME_ARGS(GST_BUFFER_PTS(buffer)),
                     spidar::filter::fault_text(report.fault));
    return;
  }
  const spidar::Frame& found = report.frame;
  GST_LOG_OBJECT(self,
                 "frame of %" GST_TIME_FORMAT
                 ": %.1f, %.1f px/s, %zu objects, %.3f, %.3f N in "
                 "%" G_GINT64_FORMAT " us%s%s",
                 GST_TIME_ARGS(static_cast<GstClockTime>(report.stamp.running_ns)),
                 found.motion.velocity_px_s.x(), found.motion.velocity_px_s.y(),
                 found.objects.size(), found.wrench.force_N.x(), found.wrench.force_N.y(),
                 static_cast<gint64>(report.took_ns / 1000),
                 found.has_motion_before() ? "" : ", restarted",
                 found.is_continuation() ? ", goes on" : "");
}

static bool check_device(MotionState& state) {
  return state.warnings.device().check(state.feed.output.session(),
                                       state.frame_settings.on_device_error);
}

static GstFlowReturn gst_spidar_motion_transform_frame_ip(GstVideoFilter* filter,
                                                          GstVideoFrame* frame) {
  const AnalysisPermit permit;
  if (!permit) return GST_FLOW_OK;
  GstSpidarMotionFilter* self = GST_SPIDAR_MOTION(filter);
  MotionState& state = *self->state;
  const spidar::FrameSettings& settings = state.frame_settings;
  const FrameReport& report = state.report();
  const bool processed = state.warnings.guard("analysing a frame", [&] {
    complete_settings(state, *frame);
    const auto frame_ns = static_cast<gint64>(spidar::nominal_duration(frame->info));
    state.track.use_loaded(frame_ns, settings.analyzer.feel != nullptr);
    state.display.show(state.process(*frame, GST_BASE_TRANSFORM(filter)->segment), settings,
                       *frame);
  });
  if (!processed) {
    state.film.begin_run();
    state.feed.reliefs.clear();
    return GST_FLOW_OK;
  }
  log_frame(self, report, frame->buffer);
  state.warnings.check_frame(report);
  state.warnings.check_touch(state.feed.output, report, settings.touch);
  if (report.analyzed) {
    const auto stream_time = static_cast<GstClockTime>(report.stamp.stream_ns);
    state.choice.check(report.frame.choice, settings.analyzer.kept, stream_time);
  }
  if (report.has_wrench() && settings.post_messages) {
    post_motion_message(GST_ELEMENT(self), GST_BUFFER_PTS(frame->buffer),
                        GST_BUFFER_DURATION(frame->buffer), report, state.unread);
  }
  return check_device(state) ? GST_FLOW_OK : GST_FLOW_ERROR;
}

/// A frame without a picture is not mapped, because mapping may have to wait for its memory.
static GstFlowReturn gst_spidar_motion_transform_ip(GstBaseTransform* trans, GstBuffer* buffer) {
  if (!GST_BUFFER_FLAG_IS_SET(buffer, GST_BUFFER_FLAG_GAP)) {
    return parent_class()->transform_ip(trans, buffer);
  }
  MotionState& state = *GST_SPIDAR_MOTION(trans)->state;
  state.warnings.guard("passing a gap", [&] { state.pass_gap(buffer, trans->segment); });
  state.display.reset();
  return check_device(state) ? GST_FLOW_OK : GST_FLOW_ERROR;
}

/// In passthrough the buffer may not be writable. A meta belongs to the buffer and not to its
/// memory, so a copy of the buffer that shares the memory is sufficient.
static GstFlowReturn gst_spidar_motion_prepare_output_buffer(GstBaseTransform* trans,
                                                             GstBuffer* input, GstBuffer** output) {
  const bool attach_meta = GST_SPIDAR_MOTION(trans)->state->frame_settings.display.attach_meta;
  if (!attach_meta || !gst_base_transform_is_passthrough(trans) || gst_buffer_is_writable(input)) {
    return parent_class()->prepare_output_buffer(trans, input, output);
  }
  *output = gst_buffer_copy(input);
  return *output ? GST_FLOW_OK : GST_FLOW_ERROR;
}

/// Whether `b` shows the same moments at the same rate as `a`.
static bool same_playback(const GstSegment& a, const GstSegment& b) {
  return a.format == b.format && a.rate == b.rate && a.start == b.start && a.base == b.base &&
         a.time == b.time && a.offset == b.offset;
}

/// Opens the trace at the first caps, so that a missing film does not overwrite the last trace.
static void open_trace(GstSpidarMotionFilter* self) {
  MotionState& state = *self->state;
  const std::string trace = std::exchange(state.next_trace, "");
  const std::string reason = trace.empty() ? "" : state.trace.open(trace);
  if (!reason.empty()) {
    GST_ELEMENT_WARNING(self, RESOURCE, OPEN_WRITE,
                        ("Cannot write the trace '%s': %s.", trace.c_str(), reason.c_str()),
                        ("The video continues without it."));
  }
}

static gboolean gst_spidar_motion_sink_event(GstBaseTransform* trans, GstEvent* event) {
  GstSpidarMotionFilter* self = GST_SPIDAR_MOTION(trans);
  MotionState& state = *self->state;
  switch (GST_EVENT_TYPE(event)) {
    case GST_EVENT_FLUSH_START:
      GST_DEBUG_OBJECT(self, "flush: scheduled wrenches are cancelled");
      state.track.loader.set_interrupted(true);
      state.feed.clear();
      break;
    case GST_EVENT_FLUSH_STOP: {
      gboolean reset_time;
      gst_event_parse_flush_stop(event, &reset_time);
      GST_DEBUG_OBJECT(self, "end of flush%s", reset_time ? ", running time starts at zero" : "");
      state.track.loader.set_interrupted(false);
      // A frame that was in progress when the flush began may have reached the loop.
      state.feed.clear();
      state.reset();
      if (reset_time) state.feed.output.follower().expect_base_time();
      break;
    }
    case GST_EVENT_STREAM_START:
      state.warnings.begin_stream();
      state.warnings.guard("looking for a track", [self] { begin_to_load_track(self); });
      // Scheduled wrenches stay: without a flush, their frames still wait for the screen.
      state.begin_epoch();
      state.orientation.begin_stream();
      break;
    case GST_EVENT_CAPS:
      open_trace(self);
      state.warnings.device().report_haptic_trace(state.feed.output.begin_trace(true));
      break;
    case GST_EVENT_TAG: {
      GstTagList* tags;
      gst_event_parse_tag(event, &tags);
      if (!spidar::follows_tag_upstream(trans->sinkpad)) state.orientation.update(tags);
      break;
    }
    case GST_EVENT_SEGMENT: {
      const GstSegment* segment;
      gst_event_parse_segment(event, &segment);
      GST_DEBUG_OBJECT(self, "segment: %" GST_SEGMENT_FORMAT, segment);
      state.track.loader.await(kLongestWait);
      if (!same_playback(trans->segment, *segment)) state.begin_epoch();
      state.feed.schedule.begin_segment();
      state.film.begin_segment();
      state.display.begin_segment();
      break;
    }
    case GST_EVENT_GAP: {
      GstClockTime time, duration;
      gst_event_parse_gap(event, &time, &duration);
      // In reverse playback, the end of the gap comes first.
      if (trans->segment.rate < 0 && GST_CLOCK_TIME_IS_VALID(duration)) time += duration;
      GST_DEBUG_OBJECT(self, "gap from %" GST_TIME_FORMAT ", force ends there",
                       GST_TIME_ARGS(time));
      state.film.begin_gap(spidar::running_time_of(trans->segment, time));
      break;
    }
    case GST_EVENT_EOS:
      GST_DEBUG_OBJECT(self, "end of stream");
      state.film.end_of_stream();
      state.feed.no_force.end();
      break;
    default:
      break;
  }
  return parent_class()->sink_event(trans, event);
}

static void process_mouse(GstSpidarMotionFilter* self, GstEvent* event) {
  MotionState& state = *self->state;
  GST_OBJECT_LOCK(self);
  const bool points = state.settings.pointer == Pointer::Kind::kMouse;
  GST_OBJECT_UNLOCK(self);
  if (!points) return;
  const auto mouse = spidar::filter::read_mouse(event, GST_BASE_TRANSFORM_SRC_PAD(self));
  if (!mouse) return;
  // While the mouse leads the hand, a move also points, but a click chooses no object.
  const bool leads_hand = state.display.hand().update(*mouse);
  if (!leads_hand || mouse->act == spidar::filter::SinkMouse::Act::kMove) {
    state.choice.mouse().update(*mouse);
  }
}

static gboolean gst_spidar_motion_src_event(GstBaseTransform* trans, GstEvent* event) {
  MotionState& state = *GST_SPIDAR_MOTION(trans)->state;
  if (GST_EVENT_TYPE(event) == GST_EVENT_LATENCY) {
    GstClockTime latency;
    gst_event_parse_latency(event, &latency);
    GST_DEBUG_OBJECT(trans, "latency: %" GST_TIME_FORMAT, GST_TIME_ARGS(latency));
    state.feed.output.follower().set_latency(latency);
  } else if (GST_EVENT_TYPE(event) == GST_EVENT_NAVIGATION) {
    process_mouse(GST_SPIDAR_MOTION(trans), event);
  } else if (GST_EVENT_TYPE(event) == GST_EVENT_RECONFIGURE) {
    GST_DEBUG_OBJECT(trans, "reconfigured: looking for the sink again");
    state.feed.output.follower().find_sink();
  } else if (GST_EVENT_TYPE(event) == GST_EVENT_INSTANT_RATE_SYNC_TIME) {
    gdouble multiplier;
    GstClockTime running_time, upstream;
    gst_event_parse_instant_rate_sync_time(event, &multiplier, &running_time, &upstream);
    GST_DEBUG_OBJECT(trans, "rate is multiplied by %g from %" GST_TIME_FORMAT " on", multiplier,
                     GST_TIME_ARGS(running_time));
    state.feed.change_rate(multiplier, running_time, upstream);
  }
  return parent_class()->src_event(trans, event);
}

static gboolean gst_spidar_motion_start(GstBaseTransform* trans) {
  GstSpidarMotionFilter* self = GST_SPIDAR_MOTION(trans);
  MotionState& state = *self->state;
  GST_OBJECT_LOCK(self);
  state.next_trace = state.settings.trace;
  GST_OBJECT_UNLOCK(self);
  GST_DEBUG_OBJECT(self, "start");
  state.warnings.start();
  state.warnings.check_bins();
  state.stats.reset();
  state.reset();
  return TRUE;
}

static gboolean gst_spidar_motion_stop(GstBaseTransform* trans) {
  MotionState& state = *GST_SPIDAR_MOTION(trans)->state;
  GST_DEBUG_OBJECT(trans, "stop");
  state.track.loader.stop();
  state.feed.clear();
  const spidar::LineWriter::Status trace = state.trace.close();
  // The report comes here, because messages during the change to NULL are discarded.
  state.warnings.check_trace(trace.error);
  if (trace.error == 0) {
    spidar::warn_of_missing_rows(GST_ELEMENT(trans), "The trace", trace.dropped);
  }
  state.warnings.device().end_haptic_trace(state.feed.output.session());
  return TRUE;
}

void gst_spidar_motion_install_stream(GstSpidarMotionFilterClass* klass) {
  GstBaseTransformClass* transform_class = GST_BASE_TRANSFORM_CLASS(klass);
  GstVideoFilterClass* filter_class = GST_VIDEO_FILTER_CLASS(klass);
  transform_class->start = gst_spidar_motion_start;
  transform_class->stop = gst_spidar_motion_stop;
  transform_class->sink_event = gst_spidar_motion_sink_event;
  transform_class->src_event = gst_spidar_motion_src_event;
  transform_class->prepare_output_buffer = gst_spidar_motion_prepare_output_buffer;
  transform_class->transform_ip = gst_spidar_motion_transform_ip;
  transform_class->before_transform = gst_spidar_motion_before_transform;
  filter_class->transform_frame_ip = gst_spidar_motion_transform_frame_ip;
}
