// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/**
 * SECTION:element-spidarsink
 * @title: spidarsink
 * @short_description: feel a haptic track with a SPIDAR haptic device
 *
 * Plays a haptic track as made by spidarextract and spidartrack: sound with six channels, force x,
 * y, z and torque x, y, z, in which 1.0 is 10 N or 1 N m. The format is F32, S16, S24 or S32, with
 * 200 to 8000 samples a second and channel-mask 0 or 0x3f.
 *
 * A player may convert any sound to this form: a stream is felt only if the tag HAPTIC_FULL_SCALE
 * marks it as a haptic track, or with #GstSpidarSink:accept-unmarked. Else a warning is posted.
 *
 * A sample is felt when a video sink shows the frame of the same running time: at base time +
 * running time + pipeline latency + #GstBaseSink:ts-offset. Between two samples the force is
 * interpolated. The safety chain is that of spidarmotion. Before PLAYING, in PAUSED, and from 50 ms
 * after the last sample there is no force. The sink provides no clock.
 *
 * At another rate than 1, a track keeps its amplitude; only its time changes. For each 40 ms, the
 * element posts the message of spidarmotion, unless #GstSpidarSink:post-messages is false.
 *
 * ## Example launch line
 * |[
 * gst-launch-1.0 filesrc location=film.haptic.flac ! flacparse ! flacdec ! spidarsink
 * ]| Feels a recorded track.
 *
 * Since: 0.1
 */
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <gst/base/gstbasesink.h>

#include "core/default_limits.h"
#include "core/track/track_format.h"
#include "core/wrench_size.h"
#include "plugin/device/device_warnings.h"
#include "plugin/device/haptic_output.h"
#include "plugin/films/stream_content.h"
#include "plugin/frame/frame_fields.h"
#include "plugin/gobject/structure_fields.h"
#include "plugin/properties/device_rows.h"
#include "plugin/properties/property_table.h"
#include "plugin/reasons/no_force.h"
#include "plugin/timing/instant_rate.h"
#include "plugin/timing/loop_queue.h"
#include "plugin/tracks/sidecar.h"
#include "plugin/tracks/track_elements.h"
#include "plugin/tracks/track_input.h"
#include "plugin/tracks/track_warnings.h"

namespace spidar {
namespace {

/// Waits until `ahead_ns` before this running time. `object` is used for preroll when the sink is
/// paused meanwhile.
inline GstFlowReturn wait_until(GstBaseSink* sink, GstMiniObject* object, gint64 running_ns,
                                gint64 ahead_ns) {
  GstClockReturn waited;
  do {
    const GstFlowReturn flow = gst_base_sink_do_preroll(sink, object);
    if (flow != GST_FLOW_OK) return flow;
    const gint64 due_ns = running_ns + static_cast<gint64>(gst_base_sink_get_latency(sink)) +
                          gst_base_sink_get_ts_offset(sink) - ahead_ns;
    waited = gst_base_sink_wait_clock(sink, static_cast<GstClockTime>(MAX(due_ns, 0)), nullptr);
    if (sink->flushing) return GST_FLOW_FLUSHING;
  } while (waited == GST_CLOCK_UNSCHEDULED);
  return GST_FLOW_OK;
}

/// The properties of spidarsink. They have the names of those of spidarmotion.
struct SinkProperties {
  std::string device = "sim";
  std::string profile;  ///< empty: that of the device's board
  double max_force_N = kDefaultForce_N;
  double gain = 1;
  bool mute = false;
  bool post_messages = true;
  bool accept_unmarked = false;
  OnDeviceError on_device_error = OnDeviceError::kWarn;
  std::string haptic_trace;
};

/// All properties of spidarsink, with `stats`; `ts-offset` is inherited from GstBaseSink.
inline const PropertyTable<SinkProperties>& sink_properties() {
  // Never destroyed: a thread may still set a property while the process ends.
  static const auto& table = *new PropertyTable<SinkProperties>{{
      Property<SinkProperties>::text(
          {"device", "Device",
           "Haptic device: 'sim' (simulated SPIDAR), one that 'spidarctl list' prints, "
           "or 'auto' (what is plugged in). Opened from NULL to READY"},
          kNull, KEPT_IN(device)),
      profile_row<SinkProperties>(),
      Property<SinkProperties>::number(
          {"max-force", "Maximum force", "Largest force on the grip, in newtons"}, 0, 20,
          kControllable, KEPT_IN(max_force_N)),
      Property<SinkProperties>::number({"gain", "Gain",
                                        "Factor on force and torque of the track. A change takes "
                                        "effect after the 0.2 s of queued samples"},
                                       0, 100, kControllable, KEPT_IN(gain)),
      Property<SinkProperties>::on_off(
          {"mute", "Mute",
           "No force: it ramps to zero at once, and returns 0.2 s after this is false"},
          kControllable, KEPT_IN(mute)),
      Property<SinkProperties>::on_off({"post-messages", "Post messages",
                                        "Post a 'spidar-motion' element message for each 40 ms of "
                                        "the track, while fewer than 1000 wait on the bus"},
                                       kPlaying, KEPT_IN(post_messages)),
      Property<SinkProperties>::on_off(
          {"accept-unmarked", "Accept unmarked",
           "Feel sound of six channels without the tag that marks a haptic track"},
          kReady, KEPT_IN(accept_unmarked)),
      on_device_error_row<SinkProperties>(),
      haptic_trace_row<SinkProperties>(),
      Property<SinkProperties>::statistics(
          {"stats", "Statistics",
           "Statistics: samples and their faults, state and timing of the haptic "
           "loop"}),
  }};
  return table;
}

/// Posts for each block of samples what spidarmotion posts for a frame. Streaming thread; lives as
/// long as the element, which its messages hold.
class BlockMessages {
 public:
  explicit BlockMessages(GstElement* element) : element_(element) {}

  /// Begins another stream: its file is the track or, where there is none, the element.
  void begin_stream(GstPad* sink) {
    const std::string file = film_of(sink);
    track_ = std::make_shared<const std::string>(file.empty() ? GST_OBJECT_NAME(element_) : file);
  }

  /// `loop` is nothing while no device is open.
  void post(const TrackBlock& block, const GstSegment& segment,
            const std::optional<LoopSnapshot>& loop, bool muted) {
    const auto begin = static_cast<guint64>(block.begin_ns);
    const guint64 pts = gst_segment_position_from_running_time(&segment, GST_FORMAT_TIME, begin);
    FrameReport report;
    report.track = track_;
    report.stamp.running_ns = block.begin_ns;
    report.stamp.stream_ns =
        static_cast<int64_t>(gst_segment_to_stream_time(&segment, GST_FORMAT_TIME, pts));
    for (size_t i = 0; i < block.count; ++i) {
      const Wrench wrench = to_wrench(block.samples[i]);
      if (size_N(wrench) > size_N(report.frame.wrench)) report.frame.wrench = wrench;
    }
    report.no_force = reason_in_track(report.frame.wrench, loop);
    report.device_no_force = loop ? reason_in_device(*loop, muted) : NoForceReason::kNoDevice;
    post_motion_message(element_, pts, static_cast<GstClockTime>(block.duration_ns), report,
                        unread_);
  }

 private:
  GstElement* const element_;
  std::shared_ptr<const std::string> track_ = std::make_shared<const std::string>();
  UnreadMessages unread_;
};

}  // namespace
}  // namespace spidar

GST_DEBUG_CATEGORY_STATIC(gst_spidar_sink_debug);
#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT gst_spidar_sink_debug

using spidar::HapticOutput;
using spidar::SinkProperties;

/// Samples are sent to the haptic loop this long before they are rendered.
static constexpr gint64 kAhead_ns = 200 * 1000 * 1000;

namespace {

struct SinkState {
  explicit SinkState(GstElement* element)
      : output(element, [this] { queue.forward_waiting(); }),
        warnings(element, "The haptic track"),
        track_warnings(element),
        messages(element) {}

  std::mutex setting;             // settings must reach the output in their order
  SinkProperties settings;        // object lock
  spidar::tracks::Faults faults;  // object lock; of the stream so far
  guint64 samples = 0;            // object lock
  gint wants_no_sync = 0;         // atomic: sync=false was set, which has no effect
  spidar::LoopQueue<spidar::TrackBlock> queue{spidar::kMaxBlocksWaiting};
  HapticOutput output;
  // Streaming thread.
  spidar::tracks::Input input;
  spidar::TrackMark mark;  // as a haptic track
  spidar::DeviceWarnings warnings;
  spidar::tracks::Warnings track_warnings;
  spidar::BlockMessages messages;
};

}  // namespace

struct _GstSpidarSink {
  GstBaseSink parent;
  SinkState* state;
};

static GstStaticPadTemplate haptic_sink_template = GST_STATIC_PAD_TEMPLATE(
    "sink", GST_PAD_SINK, GST_PAD_ALWAYS,
    GST_STATIC_CAPS(
        "audio/x-raw, format = (string) { F32LE, F32BE, F64LE, F64BE, S16LE, S16BE, S24LE, S24BE, "
        "S24_32LE, S24_32BE, S32LE, S32BE }, layout = (string) { interleaved, non-interleaved }, "
        "rate = (int) [ 200, 8000 ], "
        "channels = (int) 6, channel-mask = (bitmask) { 0x0, 0x3f }"));

G_DEFINE_TYPE_WITH_CODE(GstSpidarSink, gst_spidar_sink, GST_TYPE_BASE_SINK,
                        GST_DEBUG_CATEGORY_INIT(gst_spidar_sink_debug, "spidarsink", 0,
                                                "haptic track to a SPIDAR"))
GST_ELEMENT_REGISTER_DEFINE(spidarsink, "spidarsink", GST_RANK_NONE, GST_TYPE_SPIDAR_SINK)

HapticOutput& gst_spidar_sink_output(GstSpidarSink* self) {
  return self->state->output;
}

// --- streaming thread --------------------------------------------------------------------------

static gboolean gst_spidar_sink_set_caps(GstBaseSink* sink, GstCaps* caps) {
  GstSpidarSink* self = GST_SPIDAR_SINK(sink);
  const std::string error = self->state->input.set_caps(caps);
  if (error.empty()) return TRUE;
  GST_ELEMENT_ERROR(self, STREAM, WRONG_TYPE, ("%s", error.c_str()),
                    ("caps %" GST_PTR_FORMAT, static_cast<void*>(caps)));
  return FALSE;
}

/// Accepts all caps, so that a stream of other sound fails in set_caps(), whose error explains more
/// than a failed negotiation.
static gboolean gst_spidar_sink_query(GstBaseSink* sink, GstQuery* query) {
  if (GST_QUERY_TYPE(query) != GST_QUERY_ACCEPT_CAPS) {
    return GST_BASE_SINK_CLASS(gst_spidar_sink_parent_class)->query(sink, query);
  }
  gst_query_set_accept_caps_result(query, TRUE);
  return TRUE;
}

/// Samples reach the loop ahead of their time, so render() waits instead of the base class.
static void gst_spidar_sink_get_times(GstBaseSink*, GstBuffer*, GstClockTime* start,
                                      GstClockTime* end) {
  *start = *end = GST_CLOCK_TIME_NONE;
}

static GstFlowReturn gst_spidar_sink_render(GstBaseSink* sink, GstBuffer* buffer) {
  GstSpidarSink* self = GST_SPIDAR_SINK(sink);
  GST_OBJECT_LOCK(self);
  const SinkProperties properties = self->state->settings;
  GST_OBJECT_UNLOCK(self);
  const bool is_felt = self->state->mark.is_set() || properties.accept_unmarked;
  const guint64 samples_before = self->state->input.samples();
  const GstFlowReturn flow = self->state->input.read(
      buffer, sink->segment, properties.gain, [&](const spidar::TrackBlock& block) {
        const GstFlowReturn waited =
            spidar::wait_until(sink, GST_MINI_OBJECT_CAST(buffer), block.begin_ns, kAhead_ns);
        if (waited != GST_FLOW_OK || !is_felt) return waited;
        self->state->queue.add(block);
        if (!properties.post_messages) return waited;
        self->state->messages.post(block, sink->segment, self->state->output.snapshot(),
                                   properties.mute);
        return waited;
      });
  const bool has_time =
      flow != GST_FLOW_OK || self->state->input.samples() > samples_before ||
      (sink->segment.format == GST_FORMAT_TIME && GST_BUFFER_PTS_IS_VALID(buffer));
  GST_OBJECT_LOCK(self);
  self->state->faults = self->state->input.faults();
  self->state->samples = self->state->input.samples();
  GST_OBJECT_UNLOCK(self);
  if (g_atomic_int_exchange(&self->state->wants_no_sync, FALSE)) {
    self->state->track_warnings.warn_of_sync();
  }
  if (is_felt) self->state->track_warnings.check(self->state->input.faults(), has_time);
  if (!is_felt) self->state->track_warnings.warn_of_missing_mark();
  const spidar::OnDeviceError policy = properties.on_device_error;
  if (!self->state->warnings.check(self->state->output.session(), policy)) return GST_FLOW_ERROR;
  return flow;
}

static GstFlowReturn gst_spidar_sink_wait_event(GstBaseSink* sink, GstEvent* event) {
  GstSpidarSink* self = GST_SPIDAR_SINK(sink);
  const GstFlowReturn flow = gst_base_sink_do_preroll(sink, GST_MINI_OBJECT_CAST(event));
  const bool is_end = GST_EVENT_TYPE(event) == GST_EVENT_EOS;
  const GstClockTime end = self->state->input.end();
  if (flow != GST_FLOW_OK || !is_end || !spidar::is_time(end)) return flow;
  return spidar::wait_until(sink, GST_MINI_OBJECT_CAST(event), static_cast<gint64>(end), 0);
}

static gboolean gst_spidar_sink_event(GstBaseSink* sink, GstEvent* event) {
  GstSpidarSink* self = GST_SPIDAR_SINK(sink);
  self->state->mark.update(event);
  switch (GST_EVENT_TYPE(event)) {
    case GST_EVENT_FLUSH_START:
      self->state->queue.clear();
      break;
    case GST_EVENT_FLUSH_STOP: {
      gboolean reset_time;
      gst_event_parse_flush_stop(event, &reset_time);
      // A buffer that was in progress when the flush began may have reached the loop.
      self->state->queue.clear();
      self->state->input.reset();
      if (reset_time) self->state->output.follower().expect_base_time();
      break;
    }
    case GST_EVENT_STREAM_START:
      self->state->track_warnings.start();
      self->state->messages.begin_stream(GST_BASE_SINK_PAD(sink));
      break;
    case GST_EVENT_CAPS:
      self->state->warnings.report_haptic_trace(self->state->output.begin_trace(true));
      break;
    case GST_EVENT_SEGMENT:
      self->state->input.reset();
      break;
    default:
      break;
  }
  return GST_BASE_SINK_CLASS(gst_spidar_sink_parent_class)->event(sink, event);
}

/// Sets `sync` again: without it, the base class would not wait, and the track would end at once.
static void restore_sync(GstSpidarSink* self) {
  if (gst_base_sink_get_sync(GST_BASE_SINK(self))) return;
  gst_base_sink_set_sync(GST_BASE_SINK(self), TRUE);
  g_atomic_int_set(&self->state->wants_no_sync, TRUE);
}

static gboolean gst_spidar_sink_start(GstBaseSink* sink) {
  GstSpidarSink* self = GST_SPIDAR_SINK(sink);
  self->state->warnings.start();
  self->state->input = spidar::tracks::Input();
  self->state->queue.clear();
  return TRUE;
}

static gboolean gst_spidar_sink_stop(GstBaseSink* sink) {
  GstSpidarSink* self = GST_SPIDAR_SINK(sink);
  self->state->queue.clear();
  // The report comes here, because messages during the change to NULL are discarded.
  self->state->warnings.end_haptic_trace(self->state->output.session());
  return TRUE;
}

// --- states ------------------------------------------------------------------------------------

static gboolean gst_spidar_sink_send_event(GstElement* element, GstEvent* event) {
  GstSpidarSink* self = GST_SPIDAR_SINK(element);
  if (GST_EVENT_TYPE(event) == GST_EVENT_LATENCY) {
    GstClockTime latency;
    gst_event_parse_latency(event, &latency);
    self->state->output.follower().set_latency(latency);
  }
  return GST_ELEMENT_CLASS(gst_spidar_sink_parent_class)->send_event(element, event);
}

static bool open_device(GstSpidarSink* self) {
  GST_OBJECT_LOCK(self);
  const SinkProperties properties = self->state->settings;
  GST_OBJECT_UNLOCK(self);
  SinkState& state = *self->state;
  return state.warnings.open(
      state.output, properties.device, properties.on_device_error, [&state, &properties] {
        const std::string trace_error = state.output.open(
            properties.device, properties.profile, properties.max_force_N, properties.haptic_trace);
        state.queue.connect(&state.output.session()->loop());
        return trace_error;
      });
}

static GstStateChangeReturn gst_spidar_sink_change_state(GstElement* element,
                                                         GstStateChange transition) {
  GstSpidarSink* self = GST_SPIDAR_SINK(element);
  if (transition == GST_STATE_CHANGE_NULL_TO_READY && !open_device(self)) {
    return GST_STATE_CHANGE_FAILURE;
  }
  if (transition == GST_STATE_CHANGE_PLAYING_TO_PAUSED) {
    self->state->output.follower().set_playing(false);
  }
  const GstStateChangeReturn result =
      GST_ELEMENT_CLASS(gst_spidar_sink_parent_class)->change_state(element, transition);
  if (transition == GST_STATE_CHANGE_PAUSED_TO_PLAYING && result != GST_STATE_CHANGE_FAILURE) {
    self->state->output.follower().set_playing(true);
  }
  const bool closes =
      transition == GST_STATE_CHANGE_READY_TO_NULL ||
      (transition == GST_STATE_CHANGE_NULL_TO_READY && result == GST_STATE_CHANGE_FAILURE);
  if (closes) {
    self->state->queue.connect(nullptr);
    self->state->output.close();
  }
  return result;
}

// --- object ------------------------------------------------------------------------------------

static constexpr spidar::PropertyEffect<GstSpidarSink> kSinkEffects[] = {
    {"mute", [](auto* self, auto* v) { self->state->queue.set_muted(g_value_get_boolean(v)); }},
    {"max-force",
     [](auto* self, auto* v) { self->state->output.set_max_force(g_value_get_double(v)); }},
};

static void gst_spidar_sink_set_property(GObject* object, guint id, const GValue* value,
                                         GParamSpec* spec) {
  spidar::set_property(spidar::sink_properties(), GST_SPIDAR_SINK(object), kSinkEffects, id, value,
                       spec);
}

static GstStructure* stats(GstSpidarSink* self) {
  GST_OBJECT_LOCK(self);
  const spidar::tracks::Faults faults = self->state->faults;
  const guint64 samples = self->state->samples;
  GST_OBJECT_UNLOCK(self);
  GstStructure* structure = gst_structure_new_empty("spidar-sink-stats");
  spidar::StructureFields to(structure);
  spidar::tracks::sample_fields(samples, faults, self->state->queue.refused(), to);
  self->state->output.describe(to);
  return structure;
}

static void gst_spidar_sink_get_property(GObject* object, guint id, GValue* value,
                                         GParamSpec* spec) {
  spidar::get_property(spidar::sink_properties(), GST_SPIDAR_SINK(object), stats, id, value, spec);
}

static void follow_ts_offset(GstSpidarSink* self) {
  self->state->output.follower().set_offset(gst_base_sink_get_ts_offset(GST_BASE_SINK(self)));
}

static void gst_spidar_sink_finalize(GObject* object) {
  delete GST_SPIDAR_SINK(object)->state;
  G_OBJECT_CLASS(gst_spidar_sink_parent_class)->finalize(object);
}

static void gst_spidar_sink_init(GstSpidarSink* self) {
  self->state = new SinkState(GST_ELEMENT(self));
  g_signal_connect(self, "notify::sync", G_CALLBACK(restore_sync), nullptr);
  g_signal_connect(self, "notify::ts-offset", G_CALLBACK(follow_ts_offset), nullptr);
}

static void gst_spidar_sink_class_init(GstSpidarSinkClass* klass) {
  GObjectClass* object_class = G_OBJECT_CLASS(klass);
  GstElementClass* element_class = GST_ELEMENT_CLASS(klass);
  GstBaseSinkClass* sink_class = GST_BASE_SINK_CLASS(klass);
  object_class->set_property = gst_spidar_sink_set_property;
  object_class->get_property = gst_spidar_sink_get_property;
  object_class->finalize = gst_spidar_sink_finalize;
  spidar::sink_properties().install(object_class);
  gst_element_class_set_static_metadata(element_class, "SPIDAR sink", "Sink/Hardware",
                                        "Feel a haptic track with a SPIDAR haptic device",
                                        "The gst-spidar authors");
  gst_element_class_add_static_pad_template(element_class, &haptic_sink_template);
  element_class->change_state = gst_spidar_sink_change_state;
  element_class->send_event = gst_spidar_sink_send_event;
  sink_class->set_caps = gst_spidar_sink_set_caps;
  sink_class->query = gst_spidar_sink_query;
  sink_class->get_times = gst_spidar_sink_get_times;
  sink_class->render = gst_spidar_sink_render;
  sink_class->wait_event = gst_spidar_sink_wait_event;
  sink_class->event = gst_spidar_sink_event;
  sink_class->start = gst_spidar_sink_start;
  sink_class->stop = gst_spidar_sink_stop;
}
