// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/**
 * SECTION:element-spidarmotion
 * @title: spidarmotion
 * @short_description: feel the motion of a video with a SPIDAR haptic device
 *
 * Measures how the blocks of each picture and the objects in it move, converts the motion into
 * force and torque, and renders them at the grip of a SPIDAR-G at the moment when the frame is
 * shown. The video itself passes unchanged.
 *
 * By default, the motion of the most prominent object is felt (#spidarmotion:motion), smoothed by a
 * One-Euro filter (#spidarmotion:filter-min-cutoff). With motion=mean and filter-min-cutoff=0, the
 * mean velocity of Shi-Tomasi points, tracked by Lucas-Kanade, is felt as in the paper.
 *
 * A frame is shown at base time + running time + pipeline latency + the sink's ts-offset, plus pad
 * offsets and any clocksync before the sink. Its force is felt at that time +
 * #spidarmotion:ts-offset; between two frames, the force is interpolated. Before PLAYING, in PAUSED
 * and after the end of the stream, there is no force.
 *
 * If the tag `image-orientation` says that the picture is turned or mirrored for display, such as
 * that of a phone held upright, then force, torque, the relief of #spidarmotion:touch and the
 * positions of pointer and grip are turned with the picture. Values in pixels, such as velocities
 * and objects, stay in the coordinates of the frame.
 *
 * The extension of a file determines its type: #spidarmotion:trace writes .csv or .jsonl,
 * #spidarmotion:track plays .flac, .mka, .wav or a film, #spidarmotion:feel reads .feel. For track
 * and feel, `auto` selects the file beside the film with the film's name and such an extension.
 *
 * The element posts a `spidar-motion` element message for each frame when
 * #spidarmotion:post-messages is set; `stats` has the same for the picture on the screen. The page
 * docs/elements/spidarmotion.md describes their fields.
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
#include "plugin/filter/spidar_motion.h"

#include <filesystem>
#include <string>

#include "plugin/filter/motion_state.h"
#include "plugin/filter/reports/motion_meta.h"
#include "plugin/frame/frame_fields.h"
#include "plugin/gobject/structure_fields.h"
#include "plugin/properties/property_table.h"
#include "spidar/folders.h"

GST_DEBUG_CATEGORY(gst_spidar_motion_debug);
#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT gst_spidar_motion_debug

using spidar::MotionProperties;
using spidar::filter::MotionState;

#define CAPS \
  GST_VIDEO_CAPS_MAKE(SPIDAR_VIDEO_FORMATS) "; " GST_VIDEO_CAPS_MAKE(SPIDAR_UNPACKED_FORMATS)

static GstStaticPadTemplate motion_sink_template =
    GST_STATIC_PAD_TEMPLATE("sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(CAPS));
static GstStaticPadTemplate motion_src_template =
    GST_STATIC_PAD_TEMPLATE("src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS(CAPS));

static void gst_spidar_motion_init(GstSpidarMotionFilter* self);
static void gst_spidar_motion_class_init(GstSpidarMotionFilterClass* klass);
static gpointer gst_spidar_motion_parent_class = nullptr;

/// Replaces G_DEFINE_TYPE, which needs a structure GstSpidarMotion, a name that the C API uses.
GType gst_spidar_motion_get_type() {
  static const GType type = [] {
    const GType registered = g_type_register_static_simple(
        GST_TYPE_VIDEO_FILTER, "GstSpidarMotion", sizeof(GstSpidarMotionFilterClass),
        [](gpointer klass, gpointer) {
          gst_spidar_motion_class_init(static_cast<GstSpidarMotionFilterClass*>(klass));
        },
        sizeof(GstSpidarMotionFilter),
        [](GTypeInstance* self, gpointer) {
          gst_spidar_motion_init(reinterpret_cast<GstSpidarMotionFilter*>(self));
        },
        GTypeFlags{});
    const GInterfaceInfo presets{};
    g_type_add_interface_static(registered, GST_TYPE_PRESET, &presets);
    GST_DEBUG_CATEGORY_INIT(gst_spidar_motion_debug, "spidarmotion", 0,
                            "motion of a video to a SPIDAR");
    return registered;
  }();
  return type;
}
GST_ELEMENT_REGISTER_DEFINE(spidarmotion, "spidarmotion", GST_RANK_NONE, GST_TYPE_SPIDAR_MOTION)

MotionState& gst_spidar_motion_state(GstSpidarMotionFilter* self) {
  return *self->state;
}

// --- debug window ------------------------------------------------------------------------------

/// Opens or closes the debug window according to the property and the state. If several threads
/// change these at the same time, one of them does the work for all. No thread waits for another,
/// because one of them may be the window's own thread.
static void follow_debug_window(GstSpidarMotionFilter* self) {
  MotionState& state = *self->state;
  if (g_atomic_int_add(&state.window_changes, 1) > 0) return;
  gint seen;
  do {
    seen = g_atomic_int_get(&state.window_changes);
    GST_OBJECT_LOCK(self);
    const bool wanted = state.opened && state.settings.display.debug_window;
    GST_OBJECT_UNLOCK(self);
    if (wanted) {
      state.display.open_window();
    } else {
      state.display.close_window();
    }
  } while (!g_atomic_int_compare_and_exchange(&state.window_changes, seen, 0));
}

static void set_opened(GstSpidarMotionFilter* self, bool opened) {
  GST_OBJECT_LOCK(self);
  self->state->opened = opened;
  GST_OBJECT_UNLOCK(self);
  follow_debug_window(self);
}

static gboolean gst_spidar_motion_save_window(GstSpidarMotionFilter* self, const char* path) {
  const std::string error = path ? self->state->display.save_window(path) : "no file is named";
  if (error.empty()) return TRUE;
  GST_WARNING_OBJECT(self, "cannot save the debug window as %s: %s", path, error.c_str());
  return FALSE;
}

// --- states ------------------------------------------------------------------------------------

static GstStateChangeReturn gst_spidar_motion_change_state(GstElement* element,
                                                           GstStateChange transition) {
  GstSpidarMotionFilter* self = GST_SPIDAR_MOTION(element);
  MotionState& state = *self->state;
  if (transition == GST_STATE_CHANGE_NULL_TO_READY) {
    GST_OBJECT_LOCK(self);
    const MotionProperties properties = state.settings;
    GST_OBJECT_UNLOCK(self);
    const bool may_begin = state.warnings.device().open(state.feed.output, properties.device,
                                                        properties.on_device_error, [&] {
                                                          state.film.configure(properties.analyzer);
                                                          return state.feed.open(properties);
                                                        });
    if (!may_begin) return GST_STATE_CHANGE_FAILURE;
    set_opened(self, true);
  } else if (transition == GST_STATE_CHANGE_READY_TO_PAUSED) {
    state.steps.begin();
  } else if (transition == GST_STATE_CHANGE_PLAYING_TO_PAUSED) {
    GST_DEBUG_OBJECT(self, "paused: force ramps to rest");
    state.feed.output.follower().set_playing(false);
  } else if (transition == GST_STATE_CHANGE_PAUSED_TO_READY) {
    state.track.loader.set_interrupted(true);
  }

  const GstStateChangeReturn result =
      GST_ELEMENT_CLASS(gst_spidar_motion_parent_class)->change_state(element, transition);

  switch (transition) {
    case GST_STATE_CHANGE_READY_TO_PAUSED:
      if (result == GST_STATE_CHANGE_FAILURE) state.steps.end();
      break;
    case GST_STATE_CHANGE_PAUSED_TO_PLAYING:
      if (result != GST_STATE_CHANGE_FAILURE) state.feed.output.follower().set_playing(true);
      GST_DEBUG_OBJECT(self, "playing: force may begin");
      break;
    case GST_STATE_CHANGE_PAUSED_TO_READY:
      state.steps.end();
      break;
    case GST_STATE_CHANGE_READY_TO_NULL:
      state.feed.close();
      GST_INFO_OBJECT(self, "closed the device");
      set_opened(self, false);
      break;
    default:
      break;
  }
  return result;
}

// --- object ------------------------------------------------------------------------------------

/// The effects of properties that are not read with each frame.
static constexpr spidar::PropertyEffect<GstSpidarMotionFilter> kEffects[] = {
    {"ts-offset",
     [](auto* self, auto* value) {
       self->state->feed.output.follower().set_offset(g_value_get_int64(value));
     }},
    {"mute",
     [](auto* self, auto* value) { self->state->feed.set_muted(g_value_get_boolean(value)); }},
    {"feel", [](auto* self, auto*) { self->state->choice.rules_changed(); }},
    {"pointer",
     [](auto* self, auto*) {
       self->state->choice.mouse().reset();
       self->state->display.hand().release();
     }},
    {"touch",
     [](auto* self, auto* value) {
       const bool off =
           g_value_get_enum(value) == static_cast<int>(spidar::TouchProperties::Kind::kOff);
       if (off) self->state->feed.reliefs.clear();
     }},
    {"max-force",
     [](auto* self, auto* value) {
       self->state->feed.output.set_max_force(g_value_get_double(value));
     }},
    {"overlay",
     [](auto* self, auto* value) {
       const bool draws =
           g_value_get_enum(value) != static_cast<int>(spidar::DisplayProperties::Overlay::kNone);
       gst_base_transform_set_passthrough(GST_BASE_TRANSFORM(self), !draws);
     }},
};

/// The window's own thread may wait for `setting`, so these effects run without that lock.
static constexpr spidar::PropertyEffect<GstSpidarMotionFilter> kUnlockedEffects[] = {
    {"debug-window", [](auto* self, auto*) { follow_debug_window(self); }},
};

static void gst_spidar_motion_set_property(GObject* object, guint id, const GValue* value,
                                           GParamSpec* spec) {
  GstSpidarMotionFilter* self = GST_SPIDAR_MOTION(object);
  spidar::set_property(spidar::motion_properties(), self, kEffects, id, value, spec);
  spidar::follow_property(kUnlockedEffects, self, spec, value);
}

/// Sets the folder of the presets: that of the plugin in a build folder, otherwise the installed
/// one, which GStreamer finds by itself only if it is installed under the same prefix.
static void find_presets() {
  for (const std::filesystem::path& folder :
       {spidar::own_file().parent_path(), spidar::installed(SPIDAR_PRESET_DIR)}) {
    std::error_code error;
    if (!gst_preset_get_app_dir() &&
        std::filesystem::exists(folder / "GstSpidarMotion.prs", error)) {
      gst_preset_set_app_dir(folder.c_str());
    }
  }
}

static void gst_spidar_motion_get_property(GObject* object, guint id, GValue* value,
                                           GParamSpec* spec) {
  const auto stats = [](GstSpidarMotionFilter* self) {
    GstStructure* const structure = gst_structure_new_empty("spidar-motion-stats");
    spidar::StructureFields to(structure, spidar::kInMessage);
    self->state->describe(to);
    return structure;
  };
  spidar::get_property<MotionProperties, GstSpidarMotionFilter>(
      spidar::motion_properties(), GST_SPIDAR_MOTION(object), stats, id, value, spec);
}

static void gst_spidar_motion_finalize(GObject* object) {
  delete GST_SPIDAR_MOTION(object)->state;
  G_OBJECT_CLASS(gst_spidar_motion_parent_class)->finalize(object);
}

static void gst_spidar_motion_init(GstSpidarMotionFilter* self) {
  self->state = new MotionState(GST_ELEMENT(self));
  // GstVideoFilter would drop late frames before the analysis; here the application decides with
  // `qos`.
  gst_base_transform_set_passthrough(GST_BASE_TRANSFORM(self), TRUE);
  gst_base_transform_set_qos_enabled(GST_BASE_TRANSFORM(self), FALSE);
}

static void gst_spidar_motion_class_init(GstSpidarMotionFilterClass* klass) {
  GObjectClass* object_class = G_OBJECT_CLASS(klass);
  GstElementClass* element_class = GST_ELEMENT_CLASS(klass);

  gst_spidar_motion_parent_class = g_type_class_peek_parent(klass);
  object_class->set_property = gst_spidar_motion_set_property;
  object_class->get_property = gst_spidar_motion_get_property;
  object_class->finalize = gst_spidar_motion_finalize;
  spidar::motion_properties().install(object_class);
  spidar::filter::register_motion_meta();
  find_presets();
  // gboolean save-window(const gchar *path): saves the contents of the debug window as a PNG file.
  g_signal_new_class_handler("save-window", GST_TYPE_SPIDAR_MOTION,
                             static_cast<GSignalFlags>(G_SIGNAL_RUN_LAST | G_SIGNAL_ACTION),
                             G_CALLBACK(gst_spidar_motion_save_window), nullptr, nullptr, nullptr,
                             G_TYPE_BOOLEAN, 1, G_TYPE_STRING);

  gst_element_class_set_static_metadata(
      element_class, "SPIDAR motion", "Filter/Analyzer/Video/Hardware",
      "Measures how objects move in a video and renders it as force on a haptic device",
      "The gst-spidar authors");
  gst_element_class_add_static_pad_template(element_class, &motion_sink_template);
  gst_element_class_add_static_pad_template(element_class, &motion_src_template);
  element_class->change_state = gst_spidar_motion_change_state;

  gst_spidar_motion_install_stream(klass);
}
