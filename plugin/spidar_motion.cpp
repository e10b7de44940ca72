/**
 * SECTION:element-spidarmotion
 * @title: spidarmotion
 * @short_description: feel the motion of a video with a SPIDAR haptic device
 *
 * Looks at the frames that pass, measures how the things in them move (Shi-Tomasi points, pyramidal
 * Lucas-Kanade), turns the motion into force and torque, and gives them to the grip of a SPIDAR-G
 * at the moment the frame is shown. The video itself is passed on untouched.
 *
 * By default the object that stands out most against the background is felt (#spidarmotion:motion),
 * steadied by a One-Euro filter (#spidarmotion:filter-min-cutoff). With motion=mean and
 * filter-min-cutoff=0 it is the mean velocity of all points, as in the paper.
 *
 * A frame is shown at base time + running time + pipeline latency + the sink's ts-offset (pad
 * offsets and a clocksync on the way to the sink count, too); its force is felt then
 * (+ #spidarmotion:ts-offset), between two frames it is interpolated. Before PLAYING,
 * in PAUSED and after the end there is none.
 *
 * The element posts a `spidar-motion` element message for each frame when
 * #spidarmotion:post-messages is set, with these fields: `timestamp`, `stream-time`,
 * `running-time`, `duration` (#GstClockTime), `features`, `tracked` (uint), `velocity-x`,
 * `velocity-y` (pixels of the frame per second of running time; x right, y down), `force-x`,
 * `force-y`, `force-z` (newtons; x right, y up, z towards the viewer), `torque-x`, `torque-y`,
 * `torque-z` (newton metres), `repeated` (boolean: the frame shows the picture before again),
 * `limit` (string: what has kept the force of the last second from being felt, "none" when it was)
 * and, unless that is "none", `limit-reason` (string: the same as a sentence). `stats` has the last
 * two for the picture on the screen.
 *
 * ## Example launch lines
 * |[
 * gst-launch-1.0 videotestsrc pattern=ball ! spidarmotion ! videoconvert ! autovideosink
 * ]| A moving ball drives the simulated device.
 * |[
 * gst-launch-1.0 playbin uri=file:///tmp/clip.mp4 video-filter="spidarmotion controller=linear"
 * ]| A film with sound.
 *
 * Since: 0.1
 */
#include "plugin/spidar_motion.h"

#include <exception>
#include <new>
#include <string>

#include "plugin/display/motion_display.h"
#include "plugin/motion_engine.h"
#include "plugin/reports/complaints.h"
#include "plugin/reports/motion_message.h"
#include "plugin/reports/motion_meta.h"
#include "plugin/timing/step_watch.h"

GST_DEBUG_CATEGORY(gst_spidar_motion_debug);
#define GST_CAT_DEFAULT gst_spidar_motion_debug

using spidar::FrameReport;
using spidar::MotionDisplay;
using spidar::MotionEngine;
using spidar::MotionProperties;
using spidar::OnDeviceError;
using spidar::PointerKind;

struct _GstSpidarMotion {
  GstVideoFilter parent;

  GMutex setting;                // what is set reaches the engine in the order it was set
  MotionProperties* properties;  // object lock
  gboolean opened;               // object lock: READY or above
  MotionEngine* engine;
  MotionDisplay* display;
  gboolean track_chosen;  // streaming thread: for this stream
  gint window_changes;    // atomic: how many the window has still to follow
  spidar::StepWatch* steps;
  spidar::Complaints* complaints;
};

#define CAPS_OF(formats)                                      \
  "video/x-raw, format = (string) " formats                   \
  ", width = (int) [ 16, 8192 ], height = (int) [ 16, 8192 ]" \
  ", framerate = (fraction) [ 0, max ]"
#define CAPS CAPS_OF(SPIDAR_VIDEO_FORMATS) "; " CAPS_OF(SPIDAR_UNPACKED_FORMATS)

static GstStaticPadTemplate sink_template =
    GST_STATIC_PAD_TEMPLATE("sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(CAPS));
static GstStaticPadTemplate src_template =
    GST_STATIC_PAD_TEMPLATE("src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS(CAPS));

G_DEFINE_TYPE_WITH_CODE(GstSpidarMotion, gst_spidar_motion, GST_TYPE_VIDEO_FILTER,
                        GST_DEBUG_CATEGORY_INIT(gst_spidar_motion_debug, "spidarmotion", 0,
                                                "motion of a video to a SPIDAR"))
GST_ELEMENT_REGISTER_DEFINE(spidarmotion, "spidarmotion", GST_RANK_NONE, GST_TYPE_SPIDAR_MOTION)

spidar::MotionDisplay& gst_spidar_motion_display(GstSpidarMotion* self) {
  return *self->display;
}

MotionEngine& gst_spidar_motion_engine(GstSpidarMotion* self) {
  return *self->engine;
}

// --- errors ------------------------------------------------------------------------------------

/// C++ ends here: whatever is thrown becomes an error on the bus.
template <typename Function>
static bool guarded(GstSpidarMotion* self, const char* doing, Function&& function) {
  try {
    function();
    return true;
  } catch (const spidar::ProfileError& e) {
    GST_ELEMENT_ERROR(self, RESOURCE, SETTINGS, ("%s", e.what()), ("while %s", doing));
  } catch (const spidar::DeviceError& e) {
    GST_ELEMENT_ERROR(self, RESOURCE, OPEN_READ_WRITE, ("%s", e.what()), ("while %s", doing));
  } catch (const std::exception& e) {
    GST_ELEMENT_ERROR(self, LIBRARY, FAILED, ("%s", e.what()), ("while %s", doing));
  }
  return false;
}

// --- streaming thread --------------------------------------------------------------------------

/// GST_CLOCK_TIME_NONE where the segment is not in time, as from a file source without a parser.
static GstClockTime running_time_of(const GstSegment& segment, GstClockTime time) {
  return segment.format == GST_FORMAT_TIME
             ? gst_segment_to_running_time(&segment, GST_FORMAT_TIME, time)
             : GST_CLOCK_TIME_NONE;
}

static void gst_spidar_motion_before_transform(GstBaseTransform* trans, GstBuffer* buffer) {
  if (trans->segment.format != GST_FORMAT_TIME) return;
  const GstClockTime time =
      gst_segment_to_stream_time(&trans->segment, GST_FORMAT_TIME, GST_BUFFER_PTS(buffer));
  if (GST_CLOCK_TIME_IS_VALID(time)) gst_object_sync_values(GST_OBJECT(trans), time);
}

/// Once a stream, with its first frame: before that neither the film's name nor its length is
/// known.
static void choose_track(GstSpidarMotion* self, const GstVideoInfo& info) {
  if (self->track_chosen) return;
  self->track_chosen = TRUE;
  GST_OBJECT_LOCK(self);
  const std::string wanted = self->properties->track;
  GST_OBJECT_UNLOCK(self);
  const GstClockTime frame =
      info.fps_n > 0 ? gst_util_uint64_scale_int(GST_SECOND, info.fps_d, info.fps_n) : 0;
  self->engine->set_track(
      spidar::choose_track(GST_ELEMENT(self), wanted, static_cast<gint64>(frame)));
}

static GstFlowReturn gst_spidar_motion_transform_frame_ip(GstVideoFilter* filter,
                                                          GstVideoFrame* frame) {
  GstSpidarMotion* self = GST_SPIDAR_MOTION(filter);
  spidar::AnalyzerSettings settings;
  PointerKind pointer;
  spidar::DisplayProperties display;
  bool post_messages;
  OnDeviceError on_device_error;
  GST_OBJECT_LOCK(self);
  settings = self->properties->analyzer;
  pointer = self->properties->pointer;
  display = self->properties->display;
  post_messages = self->properties->post_messages;
  on_device_error = self->properties->on_device_error;
  GST_OBJECT_UNLOCK(self);
  if (pointer == PointerKind::kGrip) {
    settings.pointer = self->engine->grip_place().value_or(settings.pointer);
  }

  FrameReport report;
  const bool processed = guarded(self, "analysing a frame", [&] {
    choose_track(self, frame->info);
    report = self->engine->process(*frame, GST_BASE_TRANSFORM(filter)->segment, settings);
    self->display->show(report, display, settings, *frame);
  });
  if (!processed) return GST_FLOW_ERROR;
  if (report.analyzed) {
    const spidar::FrameAnalysis& found = report.analysis;
    GST_LOG_OBJECT(self,
                   "frame of %" GST_TIME_FORMAT
                   ": %.1f, %.1f px/s, %d objects, %.3f, %.3f N in "
                   "%" G_GINT64_FORMAT " us%s%s",
                   GST_TIME_ARGS(report.running_time), found.motion.velocity_px_s.x(),
                   found.motion.velocity_px_s.y(), found.objects, found.wrench.force_N.x(),
                   found.wrench.force_N.y(), static_cast<gint64>(report.took_ns / 1000),
                   found.restarted ? ", restarted" : "", found.repeated ? ", repeated" : "");
  } else {
    GST_DEBUG_OBJECT(self, "frame at %" GST_TIME_FORMAT " is not analysed: %s",
                     GST_TIME_ARGS(GST_BUFFER_PTS(frame->buffer)), to_string(report.problem));
  }
  self->complaints->look_at_frame(report);
  if (display.overlay) self->complaints->look_at_overlay(frame->info);
  if (report.analyzed && post_messages) {
    post_motion_message(GST_ELEMENT(self), frame->buffer, report);
  }
  return self->complaints->look_at_device(*self->engine, on_device_error) ? GST_FLOW_OK
                                                                          : GST_FLOW_ERROR;
}

/// A frame without a picture is not even mapped: that may have to wait for its memory.
static GstFlowReturn gst_spidar_motion_transform_ip(GstBaseTransform* trans, GstBuffer* buffer) {
  if (!GST_BUFFER_FLAG_IS_SET(buffer, GST_BUFFER_FLAG_GAP)) {
    return GST_BASE_TRANSFORM_CLASS(gst_spidar_motion_parent_class)->transform_ip(trans, buffer);
  }
  GstSpidarMotion* self = GST_SPIDAR_MOTION(trans);
  GST_OBJECT_LOCK(self);
  const OnDeviceError on_device_error = self->properties->on_device_error;
  GST_OBJECT_UNLOCK(self);
  const bool passed = guarded(self, "passing a gap", [&] {
    self->engine->pass_gap(running_time_of(trans->segment, GST_BUFFER_PTS(buffer)));
  });
  self->display->skip();
  return passed && self->complaints->look_at_device(*self->engine, on_device_error)
             ? GST_FLOW_OK
             : GST_FLOW_ERROR;
}

/// In passthrough nothing is writable. A meta is added to the buffer and not to its memory, so a
/// copy of the buffer that shares the memory will do.
static GstFlowReturn gst_spidar_motion_prepare_output_buffer(GstBaseTransform* trans,
                                                             GstBuffer* input, GstBuffer** output) {
  GstSpidarMotion* self = GST_SPIDAR_MOTION(trans);
  GST_OBJECT_LOCK(self);
  const bool attach_meta = self->properties->display.attach_meta;
  GST_OBJECT_UNLOCK(self);
  if (!attach_meta || !gst_base_transform_is_passthrough(trans) || gst_buffer_is_writable(input)) {
    return GST_BASE_TRANSFORM_CLASS(gst_spidar_motion_parent_class)
        ->prepare_output_buffer(trans, input, output);
  }
  *output = gst_buffer_copy(input);
  return *output ? GST_FLOW_OK : GST_FLOW_ERROR;
}

/// Whether the same moments are shown at the same pace after `b` as after `a`.
static bool same_playback(const GstSegment& a, const GstSegment& b) {
  return a.format == b.format && a.rate == b.rate && a.start == b.start && a.base == b.base &&
         a.time == b.time && a.offset == b.offset;
}

static gboolean gst_spidar_motion_sink_event(GstBaseTransform* trans, GstEvent* event) {
  GstSpidarMotion* self = GST_SPIDAR_MOTION(trans);
  MotionEngine& engine = *self->engine;
  switch (GST_EVENT_TYPE(event)) {
    case GST_EVENT_FLUSH_START:
      GST_DEBUG_OBJECT(self, "flush: what was scheduled is cancelled");
      engine.flush();
      break;
    case GST_EVENT_FLUSH_STOP: {
      gboolean reset_time;
      gst_event_parse_flush_stop(event, &reset_time);
      GST_DEBUG_OBJECT(self, "end of flush%s", reset_time ? ", running time starts at zero" : "");
      // Again: a frame may have been on its way through when the flush began.
      engine.flush();
      engine.restart_timing();
      if (reset_time) engine.expect_base_time();
      break;
    }
    case GST_EVENT_STREAM_START:
      self->complaints->begin_stream();
      self->track_chosen = FALSE;
      break;
    case GST_EVENT_SEGMENT: {
      const GstSegment* segment;
      gst_event_parse_segment(event, &segment);
      GST_DEBUG_OBJECT(self, "segment: %" GST_SEGMENT_FORMAT, segment);
      if (!same_playback(trans->segment, *segment)) engine.restart();
      engine.begin_segment();
      break;
    }
    case GST_EVENT_GAP: {
      GstClockTime time, duration;
      gst_event_parse_gap(event, &time, &duration);
      // Played backwards it begins at its end.
      if (trans->segment.rate < 0 && GST_CLOCK_TIME_IS_VALID(duration)) time += duration;
      GST_DEBUG_OBJECT(self, "gap from %" GST_TIME_FORMAT ", force ends there",
                       GST_TIME_ARGS(time));
      engine.run_out(running_time_of(trans->segment, time));
      break;
    }
    case GST_EVENT_EOS:
      GST_DEBUG_OBJECT(self, "end of stream");
      engine.end_of_stream();
      break;
    default:
      break;
  }
  return GST_BASE_TRANSFORM_CLASS(gst_spidar_motion_parent_class)->sink_event(trans, event);
}

static gboolean gst_spidar_motion_src_event(GstBaseTransform* trans, GstEvent* event) {
  if (GST_EVENT_TYPE(event) == GST_EVENT_LATENCY) {
    GstClockTime latency;
    gst_event_parse_latency(event, &latency);
    GST_DEBUG_OBJECT(trans, "latency: %" GST_TIME_FORMAT, GST_TIME_ARGS(latency));
    GST_SPIDAR_MOTION(trans)->engine->set_latency(latency);
  } else if (GST_EVENT_TYPE(event) == GST_EVENT_RECONFIGURE) {
    GST_DEBUG_OBJECT(trans, "reconfigured: looking for the sink again");
    GST_SPIDAR_MOTION(trans)->engine->look_for_sink();
  } else if (GST_EVENT_TYPE(event) == GST_EVENT_INSTANT_RATE_SYNC_TIME) {
    gdouble multiplier;
    GstClockTime running_time, upstream;
    gst_event_parse_instant_rate_sync_time(event, &multiplier, &running_time, &upstream);
    GST_DEBUG_OBJECT(trans, "rate is multiplied by %g from %" GST_TIME_FORMAT " on", multiplier,
                     GST_TIME_ARGS(running_time));
    GST_SPIDAR_MOTION(trans)->engine->change_rate(multiplier, running_time, upstream);
  }
  return GST_BASE_TRANSFORM_CLASS(gst_spidar_motion_parent_class)->src_event(trans, event);
}

static gboolean gst_spidar_motion_start(GstBaseTransform* trans) {
  GstSpidarMotion* self = GST_SPIDAR_MOTION(trans);
  GST_OBJECT_LOCK(self);
  const std::string trace = self->properties->trace;
  GST_OBJECT_UNLOCK(self);
  GST_DEBUG_OBJECT(self, "start; trace: %s", trace.empty() ? "none" : trace.c_str());
  self->track_chosen = FALSE;
  self->complaints->start();
  self->complaints->look_at_place();
  const std::string reason = self->engine->start(trace);
  if (!reason.empty()) {
    GST_ELEMENT_WARNING(self, RESOURCE, OPEN_WRITE,
                        ("Cannot write the trace '%s': %s.", trace.c_str(), reason.c_str()),
                        ("The video goes on without it."));
  }
  return TRUE;
}

static gboolean gst_spidar_motion_stop(GstBaseTransform* trans) {
  GstSpidarMotion* self = GST_SPIDAR_MOTION(trans);
  GST_DEBUG_OBJECT(self, "stop");
  if (!self->engine->stop()) {
    GST_ELEMENT_WARNING(self, RESOURCE, WRITE, ("The end of the trace could not be written."),
                        ("Disk full?"));
  }
  // Here, because what is said on the way to NULL reaches nobody.
  if (self->engine->session()) self->engine->session()->drain_trace();
  self->complaints->look_at_haptic_trace(*self->engine);
  return TRUE;
}

// --- debug window ------------------------------------------------------------------------------

/// Open while the element is and the property says so. Of several threads that change that at a
/// time one does it for all; it may not wait for the others, for the window's own thread is one of
/// them.
static void follow_debug_window(GstSpidarMotion* self) {
  if (g_atomic_int_add(&self->window_changes, 1) > 0) return;
  gint seen;
  do {
    seen = g_atomic_int_get(&self->window_changes);
    GST_OBJECT_LOCK(self);
    const bool wanted = self->opened && self->properties->display.debug_window;
    GST_OBJECT_UNLOCK(self);
    if (wanted) {
      self->display->open_window();
    } else {
      self->display->close_window();
    }
  } while (!g_atomic_int_compare_and_exchange(&self->window_changes, seen, 0));
}

static void set_opened(GstSpidarMotion* self, bool opened) {
  GST_OBJECT_LOCK(self);
  self->opened = opened;
  GST_OBJECT_UNLOCK(self);
  follow_debug_window(self);
}

static gboolean gst_spidar_motion_save_window(GstSpidarMotion* self, const char* path) {
  const std::string problem = path ? self->display->save_window(path) : "no file is named";
  if (problem.empty()) return TRUE;
  GST_WARNING_OBJECT(self, "cannot save the debug window as %s: %s", path, problem.c_str());
  return FALSE;
}

// --- states ------------------------------------------------------------------------------------

static GstStateChangeReturn gst_spidar_motion_change_state(GstElement* element,
                                                           GstStateChange transition) {
  GstSpidarMotion* self = GST_SPIDAR_MOTION(element);
  MotionEngine& engine = *self->engine;
  if (transition == GST_STATE_CHANGE_NULL_TO_READY) {
    GST_OBJECT_LOCK(self);
    const MotionProperties properties = *self->properties;
    GST_OBJECT_UNLOCK(self);
    std::string trace_problem;
    const bool opened =
        guarded(self, "opening the device", [&] { trace_problem = engine.open(properties); });
    if (!opened) return GST_STATE_CHANGE_FAILURE;
    GST_INFO_OBJECT(self, "opened device '%s' with profile '%s'", properties.device.c_str(),
                    properties.used_profile().c_str());
    if (!trace_problem.empty()) {
      GST_ELEMENT_WARNING(self, RESOURCE, OPEN_WRITE, ("%s", trace_problem.c_str()),
                          ("The video and the force go on without it."));
    }
    set_opened(self, true);
  } else if (transition == GST_STATE_CHANGE_READY_TO_PAUSED) {
    self->steps->begin(element);
  } else if (transition == GST_STATE_CHANGE_PLAYING_TO_PAUSED) {
    GST_DEBUG_OBJECT(self, "paused: force ramps to rest");
    engine.set_playing(false);
  }

  const GstStateChangeReturn result =
      GST_ELEMENT_CLASS(gst_spidar_motion_parent_class)->change_state(element, transition);

  switch (transition) {
    case GST_STATE_CHANGE_READY_TO_PAUSED:
      if (result == GST_STATE_CHANGE_FAILURE) self->steps->end();
      break;
    case GST_STATE_CHANGE_PAUSED_TO_PLAYING:
      if (result != GST_STATE_CHANGE_FAILURE) engine.set_playing(true);
      GST_DEBUG_OBJECT(self, "playing: force may begin");
      break;
    case GST_STATE_CHANGE_PAUSED_TO_READY:
      self->steps->end();
      break;
    case GST_STATE_CHANGE_READY_TO_NULL:
      engine.close();
      GST_INFO_OBJECT(self, "closed the device");
      set_opened(self, false);
      break;
    default:
      break;
  }
  return result;
}

// --- object ------------------------------------------------------------------------------------

static void gst_spidar_motion_set_property(GObject* object, guint id, const GValue* value,
                                           GParamSpec* spec) {
  GstSpidarMotion* self = GST_SPIDAR_MOTION(object);
  g_mutex_lock(&self->setting);
  GST_OBJECT_LOCK(self);
  const bool known = set_motion_property(*self->properties, id, value);
  GST_OBJECT_UNLOCK(self);
  if (!known) G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, spec);
  if (id == spidar::kPropTsOffset) self->engine->set_offset(g_value_get_int64(value));
  if (id == spidar::kPropMute) self->engine->set_muted(g_value_get_boolean(value));
  if (id == spidar::kPropMaxForce) self->engine->set_max_force(g_value_get_double(value));
  if (id == spidar::kPropOverlay) {
    gst_base_transform_set_passthrough(GST_BASE_TRANSFORM(self), !g_value_get_boolean(value));
  }
  g_mutex_unlock(&self->setting);
  if (id == spidar::kPropDebugWindow) follow_debug_window(self);
}

static void gst_spidar_motion_get_property(GObject* object, guint id, GValue* value,
                                           GParamSpec* spec) {
  GstSpidarMotion* self = GST_SPIDAR_MOTION(object);
  if (id == spidar::kPropStats) {
    g_value_take_boxed(value, self->engine->stats());
    return;
  }
  GST_OBJECT_LOCK(self);
  const bool known = get_motion_property(*self->properties, id, value);
  GST_OBJECT_UNLOCK(self);
  if (!known) G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, spec);
}

static void gst_spidar_motion_finalize(GObject* object) {
  GstSpidarMotion* self = GST_SPIDAR_MOTION(object);
  delete self->complaints;
  delete self->steps;
  delete self->display;
  delete self->engine;
  delete self->properties;
  g_mutex_clear(&self->setting);
  G_OBJECT_CLASS(gst_spidar_motion_parent_class)->finalize(object);
}

static void gst_spidar_motion_init(GstSpidarMotion* self) {
  g_mutex_init(&self->setting);
  self->properties = new MotionProperties;
  self->engine = new MotionEngine(GST_ELEMENT(self));
  self->display = new MotionDisplay(GST_ELEMENT(self));
  self->steps = new spidar::StepWatch;
  self->complaints = new spidar::Complaints(GST_ELEMENT(self));
  // Frames are looked at and passed on. GstVideoFilter would drop late ones before that: here it is
  // the application's choice.
  gst_base_transform_set_passthrough(GST_BASE_TRANSFORM(self), TRUE);
  gst_base_transform_set_qos_enabled(GST_BASE_TRANSFORM(self), FALSE);
}

static void gst_spidar_motion_class_init(GstSpidarMotionClass* klass) {
  GObjectClass* object_class = G_OBJECT_CLASS(klass);
  GstElementClass* element_class = GST_ELEMENT_CLASS(klass);
  GstBaseTransformClass* transform_class = GST_BASE_TRANSFORM_CLASS(klass);
  GstVideoFilterClass* filter_class = GST_VIDEO_FILTER_CLASS(klass);

  object_class->set_property = gst_spidar_motion_set_property;
  object_class->get_property = gst_spidar_motion_get_property;
  object_class->finalize = gst_spidar_motion_finalize;
  spidar::install_motion_properties(object_class);
  spidar::register_motion_meta();
  // gboolean save-window(const gchar *path): what the debug window shows, as a PNG file.
  g_signal_new_class_handler("save-window", GST_TYPE_SPIDAR_MOTION,
                             static_cast<GSignalFlags>(G_SIGNAL_RUN_LAST | G_SIGNAL_ACTION),
                             G_CALLBACK(gst_spidar_motion_save_window), nullptr, nullptr, nullptr,
                             G_TYPE_BOOLEAN, 1, G_TYPE_STRING);

  gst_element_class_set_static_metadata(
      element_class, "SPIDAR motion", "Filter/Analyzer/Video/Hardware",
      "Feel the motion of a video with a SPIDAR haptic device", "gst-spidar");
  gst_element_class_add_static_pad_template(element_class, &sink_template);
  gst_element_class_add_static_pad_template(element_class, &src_template);
  element_class->change_state = gst_spidar_motion_change_state;

  transform_class->start = gst_spidar_motion_start;
  transform_class->stop = gst_spidar_motion_stop;
  transform_class->sink_event = gst_spidar_motion_sink_event;
  transform_class->src_event = gst_spidar_motion_src_event;
  transform_class->prepare_output_buffer = gst_spidar_motion_prepare_output_buffer;
  transform_class->transform_ip = gst_spidar_motion_transform_ip;
  transform_class->before_transform = gst_spidar_motion_before_transform;
  filter_class->transform_frame_ip = gst_spidar_motion_transform_frame_ip;
}
