// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Frames and events that pass through the element.
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "plugin/filter/spidar_motion_private.h"
#include "plugin/frame/motion_message.h"
#include "plugin/frame/object_metas.h"
#include "plugin/gobject/exceptions.h"
#include "plugin/timing/frame_pacer.h"
#include "plugin/tracks/sidecar.h"

#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT gst_spidar_motion_debug

using spidar::FrameReport;
using spidar::MotionEngine;
using spidar::OnDeviceError;
using spidar::PointerKind;

static GstBaseTransformClass* parent_class() {
  return GST_BASE_TRANSFORM_CLASS(g_type_class_peek(GST_TYPE_VIDEO_FILTER));
}

static void gst_spidar_motion_before_transform(GstBaseTransform* trans, GstBuffer* buffer) {
  const GstClockTime time = spidar::stream_time_of(trans->segment, GST_BUFFER_PTS(buffer));
  if (GST_CLOCK_TIME_IS_VALID(time)) gst_object_sync_values(GST_OBJECT(trans), time);
}

/// How long a stream waits for its track to be opened; frames that come before are analysed.
static constexpr std::chrono::seconds kLongestWait{3};
static void begin_to_load_track(GstSpidarMotion* self) {
  GST_OBJECT_LOCK(self);
  const std::string track = self->properties->track;
  GST_OBJECT_UNLOCK(self);
  self->engine->set_track(nullptr);
  self->felt->forget();
  const std::string film = spidar::film_of(GST_BASE_TRANSFORM_SINK_PAD(self));
  self->choice->begin_stream(film);
  self->display->begin_stream(film);
  self->loader->begin(track, film);
}

static void take_track(GstSpidarMotion* self, const GstVideoInfo& info) {
  if (const std::optional<spidar::LoadedTrack> loaded = self->loader->take()) {
    const auto frame_ns = static_cast<gint64>(spidar::nominal_duration(info));
    std::shared_ptr<spidar::ReadAhead> blocks = self->felt->judge(*loaded, frame_ns);
    // The wrenches of frames that came before it stay: some of them may be the end of another film.
    if (blocks) self->engine->set_track(std::move(blocks), loaded->path);
  }
  if (!self->felt->check()) self->engine->set_track(nullptr);
}

/// With pointer and choice of this moment, for `frame` before it is turned.
static spidar::AnalyzerSettings settings_now(GstSpidarMotion* self, const GstVideoFrame& frame,
                                             const spidar::TouchProperties& touch) {
  const bool has_new_rules = self->choice->is_to_read();
  GST_OBJECT_LOCK(self);
  spidar::AnalyzerSettings settings = self->properties->analyzer;
  const PointerKind pointer = self->properties->pointer;
  const std::string feel = has_new_rules ? self->properties->feel : "";
  GST_OBJECT_UNLOCK(self);
  if (has_new_rules) self->choice->read(feel, GST_BASE_TRANSFORM_SINK_PAD(self));
  if (pointer == PointerKind::kGrip) {
    settings.pointer = self->engine->grip_position().value_or(settings.pointer);
    self->warnings->check_pointer(*self->engine);
  }
  const spidar::Orientation& turn = self->engine->turn();
  settings.pointer = turn.stored_position(settings.pointer);
  self->choice->apply(pointer == PointerKind::kMouse, turn, settings);
  if (self->choice->wants_boxes()) {
    settings.boxes = spidar::boxes_of(frame, touch.packed(), turn);
  }
  return settings;
}

static void log_frame(GstSpidarMotion* self, const FrameReport& report, GstBuffer* buffer) {
  if (!report.has_wrench()) {
    GST_DEBUG_OBJECT(self, "frame at %" GST_TIME_FORMAT " is not analysed: %s",
                     GST_TIME_ARGS(GST_BUFFER_PTS(buffer)), words_of(report.problem));
    return;
  }
  const spidar::Frame& found = report.frame;
  GST_LOG_OBJECT(
      self,
      "frame of %" GST_TIME_FORMAT
      ": %.1f, %.1f px/s, %zu objects, %.3f, %.3f N in "
      "%" G_GINT64_FORMAT " us%s%s",
      GST_TIME_ARGS(static_cast<GstClockTime>(found.running_ns)), found.motion.velocity_px_s.x(),
      found.motion.velocity_px_s.y(), found.objects.size(), found.wrench.force_N.x(),
      found.wrench.force_N.y(), static_cast<gint64>(report.took_ns / 1000),
      found.has_motion_before() ? "" : ", restarted", found.goes_on() ? ", goes on" : "");
}

static bool device_goes_on(GstSpidarMotion* self, OnDeviceError policy) {
  return self->warnings->device().check(self->engine->output().session(), policy);
}

static GstFlowReturn gst_spidar_motion_transform_frame_ip(GstVideoFilter* filter,
                                                          GstVideoFrame* frame) {
  GstSpidarMotion* self = GST_SPIDAR_MOTION(filter);
  spidar::AnalyzerSettings settings;
  spidar::DisplayProperties display;
  spidar::TouchProperties touch;
  bool post_messages;
  OnDeviceError on_device_error;
  GST_OBJECT_LOCK(self);
  display = self->properties->display;
  touch = self->properties->touch;
  post_messages = self->properties->post_messages;
  on_device_error = self->properties->on_device_error;
  GST_OBJECT_UNLOCK(self);

  FrameReport* report = nullptr;
  const bool processed = spidar::guarded(GST_ELEMENT(self), "analysing a frame", [&] {
    settings = settings_now(self, *frame, touch);
    take_track(self, frame->info);
    report = &self->engine->process({*frame, GST_BASE_TRANSFORM(filter)->segment, settings, touch});
    self->display->show(*report, display, settings.axes, *frame);
  });
  if (!processed) {
    // The application may leave the pipeline in PLAYING.
    self->engine->stop_touching();
    return GST_FLOW_ERROR;
  }
  log_frame(self, *report, frame->buffer);
  self->warnings->check_frame(*report);
  self->warnings->check_touch(*self->engine, *report, touch);
  if (report->analyzed) {
    const auto stream_time = static_cast<GstClockTime>(report->frame.stream_ns);
    self->choice->check(report->frame.choice, settings.kept, stream_time);
  }
  if (report->has_wrench() && post_messages) {
    post_motion_message(GST_ELEMENT(self), GST_BUFFER_PTS(frame->buffer),
                        GST_BUFFER_DURATION(frame->buffer), *report, &self->unread_messages);
  }
  return device_goes_on(self, on_device_error) ? GST_FLOW_OK : GST_FLOW_ERROR;
}

/// A frame without a picture is not mapped, because mapping may have to wait for its memory.
static GstFlowReturn gst_spidar_motion_transform_ip(GstBaseTransform* trans, GstBuffer* buffer) {
  if (!GST_BUFFER_FLAG_IS_SET(buffer, GST_BUFFER_FLAG_GAP)) {
    return parent_class()->transform_ip(trans, buffer);
  }
  GstSpidarMotion* self = GST_SPIDAR_MOTION(trans);
  GST_OBJECT_LOCK(self);
  const OnDeviceError on_device_error = self->properties->on_device_error;
  GST_OBJECT_UNLOCK(self);
  const bool passed = spidar::guarded(GST_ELEMENT(self), "passing a gap",
                                      [&] { self->engine->pass_gap(buffer, trans->segment); });
  self->display->skip();
  return passed && device_goes_on(self, on_device_error) ? GST_FLOW_OK : GST_FLOW_ERROR;
}

/// In passthrough the buffer may not be writable. A meta belongs to the buffer and not to its
/// memory, so a copy of the buffer that shares the memory is sufficient.
static GstFlowReturn gst_spidar_motion_prepare_output_buffer(GstBaseTransform* trans,
                                                             GstBuffer* input, GstBuffer** output) {
  GstSpidarMotion* self = GST_SPIDAR_MOTION(trans);
  GST_OBJECT_LOCK(self);
  const bool attach_meta = self->properties->display.attach_meta;
  GST_OBJECT_UNLOCK(self);
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

static gboolean gst_spidar_motion_sink_event(GstBaseTransform* trans, GstEvent* event) {
  GstSpidarMotion* self = GST_SPIDAR_MOTION(trans);
  MotionEngine& engine = *self->engine;
  switch (GST_EVENT_TYPE(event)) {
    case GST_EVENT_FLUSH_START:
      GST_DEBUG_OBJECT(self, "flush: scheduled wrenches are cancelled");
      self->loader->interrupt();
      engine.flush();
      break;
    case GST_EVENT_FLUSH_STOP: {
      gboolean reset_time;
      gst_event_parse_flush_stop(event, &reset_time);
      GST_DEBUG_OBJECT(self, "end of flush%s", reset_time ? ", running time starts at zero" : "");
      self->loader->resume();
      // Flushes again, because a frame may have been in progress when the flush began.
      engine.flush();
      engine.restart_timing();
      if (reset_time) engine.output().expect_base_time();
      break;
    }
    case GST_EVENT_STREAM_START:
      self->warnings->begin_stream();
      spidar::guarded(GST_ELEMENT(self), "looking for a track",
                      [self] { begin_to_load_track(self); });
      engine.begin_stream();
      break;
    case GST_EVENT_TAG: {
      GstTagList* tags;
      gst_event_parse_tag(event, &tags);
      if (!spidar::follows_tag_upstream(GST_BASE_TRANSFORM_SINK_PAD(trans))) engine.take_tags(tags);
      break;
    }
    case GST_EVENT_SEGMENT: {
      const GstSegment* segment;
      gst_event_parse_segment(event, &segment);
      GST_DEBUG_OBJECT(self, "segment: %" GST_SEGMENT_FORMAT, segment);
      self->loader->await(kLongestWait);
      if (!same_playback(trans->segment, *segment)) engine.restart();
      engine.begin_segment();
      break;
    }
    case GST_EVENT_GAP: {
      GstClockTime time, duration;
      gst_event_parse_gap(event, &time, &duration);
      // In reverse playback the gap begins at its end.
      if (trans->segment.rate < 0 && GST_CLOCK_TIME_IS_VALID(duration)) time += duration;
      GST_DEBUG_OBJECT(self, "gap from %" GST_TIME_FORMAT ", force ends there",
                       GST_TIME_ARGS(time));
      engine.begin_gap(spidar::running_time_of(trans->segment, time));
      break;
    }
    case GST_EVENT_EOS:
      GST_DEBUG_OBJECT(self, "end of stream");
      engine.end_of_stream();
      break;
    default:
      break;
  }
  return parent_class()->sink_event(trans, event);
}

static void take_mouse(GstSpidarMotion* self, GstEvent* event) {
  GST_OBJECT_LOCK(self);
  const bool points = self->properties->pointer == PointerKind::kMouse;
  GST_OBJECT_UNLOCK(self);
  if (!points) return;
  const auto mouse = spidar::read_mouse(event, GST_BASE_TRANSFORM_SRC_PAD(self));
  if (!mouse) return;
  // A hand that is led points, too, but its clicks are no choice of objects.
  const bool leads_hand = self->display->hand().take(*mouse);
  if (!leads_hand || mouse->act == spidar::SinkMouse::Act::kMove)
    self->choice->mouse().take(*mouse);
}

static gboolean gst_spidar_motion_src_event(GstBaseTransform* trans, GstEvent* event) {
  if (GST_EVENT_TYPE(event) == GST_EVENT_LATENCY) {
    GstClockTime latency;
    gst_event_parse_latency(event, &latency);
    GST_DEBUG_OBJECT(trans, "latency: %" GST_TIME_FORMAT, GST_TIME_ARGS(latency));
    GST_SPIDAR_MOTION(trans)->engine->output().set_latency(latency);
  } else if (GST_EVENT_TYPE(event) == GST_EVENT_NAVIGATION) {
    take_mouse(GST_SPIDAR_MOTION(trans), event);
  } else if (GST_EVENT_TYPE(event) == GST_EVENT_RECONFIGURE) {
    GST_DEBUG_OBJECT(trans, "reconfigured: looking for the sink again");
    GST_SPIDAR_MOTION(trans)->engine->output().look_for_sink();
  } else if (GST_EVENT_TYPE(event) == GST_EVENT_INSTANT_RATE_SYNC_TIME) {
    gdouble multiplier;
    GstClockTime running_time, upstream;
    gst_event_parse_instant_rate_sync_time(event, &multiplier, &running_time, &upstream);
    GST_DEBUG_OBJECT(trans, "rate is multiplied by %g from %" GST_TIME_FORMAT " on", multiplier,
                     GST_TIME_ARGS(running_time));
    GST_SPIDAR_MOTION(trans)->engine->change_rate(multiplier, running_time, upstream);
  }
  return parent_class()->src_event(trans, event);
}

static gboolean gst_spidar_motion_start(GstBaseTransform* trans) {
  GstSpidarMotion* self = GST_SPIDAR_MOTION(trans);
  GST_OBJECT_LOCK(self);
  const std::string trace = self->properties->trace;
  GST_OBJECT_UNLOCK(self);
  GST_DEBUG_OBJECT(self, "start; trace: %s", trace.empty() ? "none" : trace.c_str());
  self->warnings->start();
  self->warnings->check_bins();
  const std::string reason = self->engine->start(trace);
  if (!reason.empty()) {
    GST_ELEMENT_WARNING(self, RESOURCE, OPEN_WRITE,
                        ("Cannot write the trace '%s': %s.", trace.c_str(), reason.c_str()),
                        ("The video continues without it."));
  }
  return TRUE;
}

static gboolean gst_spidar_motion_stop(GstBaseTransform* trans) {
  GstSpidarMotion* self = GST_SPIDAR_MOTION(trans);
  GST_DEBUG_OBJECT(self, "stop");
  self->loader->stop();
  const spidar::LineWriter::Status trace = self->engine->stop();
  // Reported here, because messages during the change to NULL are discarded.
  self->warnings->check_trace(trace.error);
  if (trace.error == 0) spidar::warn_of_missing_rows(GST_ELEMENT(self), "The trace", trace.dropped);
  self->warnings->device().end_haptic_trace(self->engine->output().session());
  return TRUE;
}

void gst_spidar_motion_install_stream(GstSpidarMotionClass* klass) {
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
