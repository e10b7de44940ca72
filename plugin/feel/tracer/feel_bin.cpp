// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/feel/tracer/feel_bin.h"

#include <atomic>
#include <string>

#include <gst/video/video.h>

#include "plugin/feel/tracer/small_copy.h"
#include "plugin/frame/stream_orientation.h"
#include "plugin/gobject/downstream.h"
#include "plugin/gobject/set_text.h"

using spidar::Ref;

GST_DEBUG_CATEGORY_STATIC(gst_spidar_feel_debug);
#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT gst_spidar_feel_debug

struct _GstSpidarFeelBin {
  GstBin parent;

  gchar* properties;
  bool turns;  // whether the bin turns pictures, because the player does not
  // The elements of the bin, in this order.
  GstElement* before;
  GstElement* flip;    // null until a picture must be turned
  GstElement* middle;  // accepts what spidarmotion accepts; kept while spidarmotion is in its place
  GstElement* after;
  // The spidarmotion that has the device; null: nothing is felt. It replaces the middle when the
  // first data come. Read by the streaming thread and written in state changes, atomically.
  GstElement* motion;
  // Between `before` and `after`: the middle, that spidarmotion, or a bin that gives it small
  // copies of frames in GPU memory.
  GstElement* in_place;
  // For the streaming thread: how pictures must be turned for display, and whether no element does
  // so.
  spidar::StreamOrientation orientation;
  bool is_misoriented;
};

G_DEFINE_FINAL_TYPE(GstSpidarFeelBin, gst_spidar_feel_bin, GST_TYPE_BIN)

static std::atomic<GstSpidarFeelBin*> device_owner{nullptr};

static bool reserve_device(GstSpidarFeelBin* self) {
  GstSpidarFeelBin* nobody = nullptr;
  return device_owner.compare_exchange_strong(nobody, self);
}

static void release_device(GstSpidarFeelBin* self) {
  device_owner.compare_exchange_strong(self, nullptr);
}

/// Whether the application has put a spidarmotion into the pipeline itself.
static bool is_felt_already(GstSpidarFeelBin* self) {
  const Ref<GstObject> top = spidar::root_of(self);
  GstIterator* all =
      gst_bin_iterate_all_by_element_factory_name(GST_BIN(top.get()), "spidarmotion");
  GValue found = G_VALUE_INIT;
  GstIteratorResult result;
  // The application may add or remove elements meanwhile.
  while ((result = gst_iterator_next(all, &found)) == GST_ITERATOR_RESYNC) gst_iterator_resync(all);
  const bool felt = result == GST_ITERATOR_OK;
  g_value_unset(&found);
  gst_iterator_free(all);
  return felt;
}

static void set_properties(GstElement* motion, const char* properties) {
  gchar** lines = g_strsplit(properties, "\n", -1);
  for (gchar** line = lines; *line; ++line) {
    if (!strchr(*line, '=')) continue;
    const std::string unknown = spidar::set_text(motion, *line);
    if (!unknown.empty()) {
      GST_WARNING_OBJECT(motion, "spidarmotion has no property %s", unknown.c_str());
    }
  }
  g_strfreev(lines);
}

static bool is_set(const char* properties, const char* name) {
  gchar** lines = g_strsplit(properties, "\n", -1);
  bool found = false;
  for (gchar** line = lines; *line && !found; ++line) {
    const size_t length = strlen(name);
    found = strncmp(*line, name, length) == 0 && (*line)[length] == '=';
  }
  g_strfreev(lines);
  return found;
}

/// The caps of the frames; empty before the first.
static Ref<GstCaps> current_caps(GstSpidarFeelBin* self) {
  const Ref<GstPad> pad(gst_element_get_static_pad(self->before, "sink"));
  GstCaps* const caps = gst_pad_get_current_caps(pad.get());
  return Ref<GstCaps>(caps ? caps : gst_caps_new_empty());
}

/// Shows the force when there is no device, unless the user has chosen what is drawn.
static void show_without_device(GstSpidarFeelBin* self, GstElement* motion, GstMessage* message) {
  const GstStructure* told = gst_message_get_structure(message);
  gboolean simulated = FALSE;
  if (gst_structure_has_name(told, "spidar-device") &&
      gst_structure_get_boolean(told, "simulated", &simulated) && simulated &&
      !is_set(self->properties, "overlay")) {
    // Nothing is drawn into frames in GPU memory.
    const bool is_drawn = !spidar::is_in_gpu(current_caps(self).get());
    gst_util_set_object_arg(G_OBJECT(motion), is_drawn ? "overlay" : "debug-window",
                            is_drawn ? "curve" : "true");
  }
}

/// Passes a message on, so that the video continues: an error of the device becomes a warning in
/// the player. Players may hide messages, so they are also printed on standard error.
static void pass_on(GstSpidarFeelBin* self, GstMessage* message) {
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ELEMENT) {
    gst_element_post_message(GST_ELEMENT(self), gst_message_ref(message));
    return;
  }
  GError* error = nullptr;
  gchar* details = nullptr;
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) {
    gst_message_parse_error(message, &error, &details);
  } else if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_WARNING) {
    gst_message_parse_warning(message, &error, &details);
  } else {
    gst_message_parse_info(message, &error, &details);
  }
  const bool refused = GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR;
  constexpr const char* kWithout = "The video goes on without force.";
  g_printerr("spidar-feel: %s%s%s\n", error->message, refused ? ". " : "", refused ? kWithout : "");
  // The new message has the code and location of the old one.
  const auto message_of = GST_MESSAGE_TYPE(message) == GST_MESSAGE_INFO ? gst_message_new_info
                                                                        : gst_message_new_warning;
  gst_element_post_message(GST_ELEMENT(self),
                           message_of(GST_OBJECT(self), error, refused ? kWithout : details));
  g_clear_error(&error);
  g_free(details);
}

/// Returns a spidarmotion that has opened its device, or null. It is in no bin yet, so its messages
/// are collected on a bus of its own.
static Ref<GstElement> open_motion(GstSpidarFeelBin* self) {
  Ref<GstElement> motion = spidar::sunk(gst_element_factory_make("spidarmotion", nullptr));
  if (!motion) return nullptr;
  g_object_set(motion.get(), "track", "auto", nullptr);
  set_properties(motion.get(), self->properties);
  const Ref<GstBus> bus(gst_bus_new());
  gst_element_set_bus(motion.get(), bus.get());
  // Without a device, no spidarmotion may measure the frames, whatever the user requests later.
  gint while_playing = 0;
  g_object_get(motion.get(), "on-device-error", &while_playing, nullptr);
  gst_util_set_object_arg(G_OBJECT(motion.get()), "on-device-error", "error");
  const bool opened =
      gst_element_set_state(motion.get(), GST_STATE_READY) != GST_STATE_CHANGE_FAILURE;
  g_object_set(motion.get(), "on-device-error", while_playing, nullptr);
  const auto kinds = static_cast<GstMessageType>(GST_MESSAGE_ERROR | GST_MESSAGE_WARNING |
                                                 GST_MESSAGE_INFO | GST_MESSAGE_ELEMENT);
  while (GstMessage* message = gst_bus_pop_filtered(bus.get(), kinds)) {
    if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ELEMENT) {
      show_without_device(self, motion.get(), message);
    }
    pass_on(self, message);
    gst_message_unref(message);
  }
  gst_element_set_bus(motion.get(), nullptr);
  gst_bus_set_flushing(bus.get(), TRUE);
  if (opened) return motion;
  gst_element_set_state(motion.get(), GST_STATE_NULL);
  return nullptr;
}

/// Links without another negotiation upstream: `to` accepts the previous caps. theoradec fails when
/// it must negotiate during a seek.
static void link_quietly(GstElement* from, GstElement* to) {
  constexpr auto kQuietly =
      static_cast<GstPadLinkCheck>(GST_PAD_LINK_CHECK_DEFAULT | GST_PAD_LINK_CHECK_NO_RECONFIGURE);
  gst_element_link_pads_full(from, "src", to, "sink", kQuietly);
}

static GstElement* front(GstSpidarFeelBin* self) {
  return self->flip ? self->flip : self->before;
}

/// Replaces the element between `before` and `after` by `in`. No data may flow there meanwhile.
static void replace_element(GstSpidarFeelBin* self, GstElement* in) {
  GstElement* const out = self->in_place;
  gst_element_unlink_many(front(self), out, self->after, nullptr);
  // In READY, unlike NULL, a spidarmotion keeps its device, at rest, for frames that it can
  // measure.
  gst_element_set_state(out, GST_STATE_READY);
  gst_bin_remove(GST_BIN(self), out);
  gst_bin_add(GST_BIN(self), in);
  link_quietly(in, self->after);
  link_quietly(front(self), in);
  self->in_place = in;
  spidar::follow_state(GST_ELEMENT(self), in);
}

static void stop_measuring(GstSpidarFeelBin* self) {
  if (self->in_place == self->middle) return;
  const Ref<GstElement> before = spidar::new_ref(self->in_place);
  replace_element(self, self->middle);
  if (before.get() == self->motion) return;
  gst_bin_remove(GST_BIN(before.get()), self->motion);
  gst_element_set_state(before.get(), GST_STATE_NULL);
}

/// Makes spidarmotion measure frames of `caps`.
static void measure(GstSpidarFeelBin* self, const GstCaps* caps) {
  const bool in_gpu = spidar::is_in_gpu(caps);
  if (self->in_place == self->motion && !in_gpu) return;
  stop_measuring(self);
  GstElement* const in = in_gpu ? spidar::small_copy_bin_new(caps, self->motion) : self->motion;
  if (in) replace_element(self, in);
}

/// Whether the element turns pictures as their tag image-orientation says.
static bool follows_tag(GstElement* element) {
  for (const char* name : {"video-direction", "rotate-method", "orientation"}) {
    const GParamSpec* const property =
        g_object_class_find_property(G_OBJECT_GET_CLASS(element), name);
    if (!property || !G_IS_PARAM_SPEC_ENUM(property)) continue;
    gint value = 0;
    g_object_get(element, name, &value, nullptr);
    const GEnumValue* const method =
        g_enum_get_value(G_PARAM_SPEC_ENUM(property)->enum_class, value);
    if (method && g_str_has_prefix(method->value_nick, "auto")) return true;
  }
  return false;
}

/// Whether pictures are turned behind this bin: by an element, or by WebKit, when it draws them.
static bool is_turned_behind(GstSpidarFeelBin* self) {
  return g_strcmp0(g_get_prgname(), "WebKitWebProcess") == 0 ||
         !spidar::find_path_downstream(GST_ELEMENT(self), follows_tag).empty();
}

/// Marks a turned picture as upright. The videoflip of GStreamer 1.22 leaves the tag as it was.
static GstPadProbeReturn set_upright(GstPad*, GstPadProbeInfo* info, gpointer) {
  auto* event = GST_PAD_PROBE_INFO_EVENT(info);
  if (GST_EVENT_TYPE(event) != GST_EVENT_TAG) return GST_PAD_PROBE_OK;
  GstTagList* tags = nullptr;
  gst_event_parse_tag(event, &tags);
  if (gst_tag_list_get_tag_size(tags, GST_TAG_IMAGE_ORIENTATION) == 0) return GST_PAD_PROBE_OK;
  tags = gst_tag_list_copy(tags);
  gst_tag_list_add(tags, GST_TAG_MERGE_REPLACE, GST_TAG_IMAGE_ORIENTATION, "rotate-0", nullptr);
  info->data = gst_event_new_tag(tags);
  gst_event_unref(event);
  return GST_PAD_PROBE_OK;
}

static void add_flip(GstSpidarFeelBin* self) {
  if (spidar::is_in_gpu(current_caps(self).get())) return;
  GstElement* const flip = gst_element_factory_make("videoflip", nullptr);
  if (!flip) return;
  const Ref<GstPad> source(gst_element_get_static_pad(flip, "src"));
  gst_pad_add_probe(source.get(), GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM, set_upright, nullptr,
                    nullptr);
  gst_element_unlink(self->before, self->in_place);
  gst_bin_add(GST_BIN(self), flip);
  gst_element_link_many(self->before, flip, self->in_place, nullptr);
  self->flip = flip;
  spidar::follow_state(GST_ELEMENT(self), flip);
}

/// Sets a direction: with auto, the videoflip of GStreamer 1.22 would turn the next film, too.
static void turn_pictures(GstSpidarFeelBin* self) {
  const GstVideoOrientationMethod method = self->orientation.method();
  self->is_misoriented =
      method != GST_VIDEO_ORIENTATION_IDENTITY && !self->flip && !is_turned_behind(self);
  if (self->is_misoriented && self->turns) add_flip(self);
  if (!self->flip) return;
  self->is_misoriented = false;
  g_object_set(self->flip, "video-direction", method, nullptr);
}

static void update_orientation(GstSpidarFeelBin* self, GstEvent* event) {
  GstTagList* tags = nullptr;
  gst_event_parse_tag(event, &tags);
  if (self->orientation.update(tags)) turn_pictures(self);
}

static void begin_stream(GstSpidarFeelBin* self) {
  self->orientation.begin_stream();
  turn_pictures(self);
}

static void warn_of_orientation(GstSpidarFeelBin* self) {
  static std::atomic<bool> has_warned{false};
  self->is_misoriented = false;
  if (has_warned.exchange(true)) return;
  constexpr const char* kHelp =
      "unless the player turns it, force and picture do not agree: spidar-feel FILM turns it";
  g_printerr(
      "spidar-feel: this film is stored on its side or mirrored, and is felt as it is to be shown; "
      "%s\n",
      self->turns ? "videoflip of gst-plugins-good, which turns it, is not installed" : kHelp);
}

/// Puts spidarmotion into the bin, before the data reach `before`. The probe stays on the pad: data
/// may flow at any time, also while the bin begins to play.
static GstPadProbeReturn before_data(GstPad*, GstPadProbeInfo* info, gpointer data) {
  GstSpidarFeelBin* self = GST_SPIDAR_FEEL_BIN(data);
  auto* motion = static_cast<GstElement*>(g_atomic_pointer_get(&self->motion));
  if ((info->type & GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM) != 0) {
    GstEvent* const event = GST_PAD_PROBE_INFO_EVENT(info);
    if (GST_EVENT_TYPE(event) == GST_EVENT_STREAM_START) begin_stream(self);
    if (GST_EVENT_TYPE(event) == GST_EVENT_TAG) update_orientation(self, event);
    if (GST_EVENT_TYPE(event) != GST_EVENT_CAPS) return GST_PAD_PROBE_OK;
  }
  GstCaps* caps = nullptr;
  if ((info->type & GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM) != 0) {
    gst_event_parse_caps(GST_PAD_PROBE_INFO_EVENT(info), &caps);
  }
  if (motion && caps) measure(self, caps);
  if (motion && !caps && self->in_place == self->middle) measure(self, current_caps(self).get());
  if (motion && self->is_misoriented) warn_of_orientation(self);
  return GST_PAD_PROBE_OK;
}

/// Replaces an error during a flush by GST_FLOW_FLUSHING. After the middle was replaced, `before`
/// sends caps and segment again, which fails when a seek flushes the bin and would stop the player.
/// The seek drops this frame anyway, and marks the pad of the bin before the elements in it.
static GstFlowReturn failed_or_flushed(GstPad* pad, GstFlowReturn result) {
  if (result != GST_FLOW_NOT_NEGOTIATED && result != GST_FLOW_ERROR) return result;
  GST_OBJECT_LOCK(pad);
  const bool flushing = GST_PAD_IS_FLUSHING(pad);
  GST_OBJECT_UNLOCK(pad);
  return flushing ? GST_FLOW_FLUSHING : result;
}

static GstFlowReturn chain(GstPad* pad, GstObject* parent, GstBuffer* buffer) {
  return failed_or_flushed(pad, gst_proxy_pad_chain_default(pad, parent, buffer));
}

static GstFlowReturn chain_list(GstPad* pad, GstObject* parent, GstBufferList* list) {
  return failed_or_flushed(pad, gst_proxy_pad_chain_list_default(pad, parent, list));
}

static void begin_to_feel(GstSpidarFeelBin* self) {
  if (self->motion || is_felt_already(self) || !reserve_device(self)) return;
  if (Ref<GstElement> motion = open_motion(self)) {
    g_atomic_pointer_set(&self->motion, motion.release());
  } else {
    release_device(self);
  }
}

/// Call this while the pads of all elements are inactive.
static void stop_feeling(GstSpidarFeelBin* self) {
  if (!self->motion) return;
  stop_measuring(self);
  const Ref<GstElement> motion(self->motion);
  g_atomic_pointer_set(&self->motion, static_cast<GstElement*>(nullptr));
  gst_element_set_state(motion.get(), GST_STATE_NULL);
  release_device(self);
}

static GstStateChangeReturn gst_spidar_feel_bin_change_state(GstElement* element,
                                                             GstStateChange transition) {
  GstSpidarFeelBin* self = GST_SPIDAR_FEEL_BIN(element);
  if (transition == GST_STATE_CHANGE_PAUSED_TO_PLAYING) begin_to_feel(self);
  const GstStateChangeReturn result =
      GST_ELEMENT_CLASS(gst_spidar_feel_bin_parent_class)->change_state(element, transition);
  if (transition == GST_STATE_CHANGE_PAUSED_TO_READY) stop_feeling(self);
  return result;
}

/// Passes on information from spidarmotion, such as which track is felt, because players hide it.
static void gst_spidar_feel_bin_handle_message(GstBin* bin, GstMessage* message) {
  GstSpidarFeelBin* self = GST_SPIDAR_FEEL_BIN(bin);
  const gpointer motion = g_atomic_pointer_get(&self->motion);
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_INFO && GST_MESSAGE_SRC(message) == motion) {
    pass_on(self, message);
    gst_message_unref(message);
    return;
  }
  GST_BIN_CLASS(gst_spidar_feel_bin_parent_class)->handle_message(bin, message);
}

static void gst_spidar_feel_bin_finalize(GObject* object) {
  GstSpidarFeelBin* self = GST_SPIDAR_FEEL_BIN(object);
  if (self->middle) gst_element_set_state(self->middle, GST_STATE_NULL);
  gst_clear_object(&self->middle);
  g_free(self->properties);
  G_OBJECT_CLASS(gst_spidar_feel_bin_parent_class)->finalize(object);
}

static void gst_spidar_feel_bin_init(GstSpidarFeelBin* self) {
  self->orientation.begin_stream();
}

static void gst_spidar_feel_bin_class_init(GstSpidarFeelBinClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_spidar_feel_debug, "spidarfeel", 0, "players that are felt");
  G_OBJECT_CLASS(klass)->finalize = gst_spidar_feel_bin_finalize;
  GST_ELEMENT_CLASS(klass)->change_state = gst_spidar_feel_bin_change_state;
  GST_BIN_CLASS(klass)->handle_message = gst_spidar_feel_bin_handle_message;
  gst_element_class_set_static_metadata(
      GST_ELEMENT_CLASS(klass), "Felt video", "Filter/Analyzer/Video/Hardware",
      "spidarmotion for players that offer no way to add a filter", "The gst-spidar authors");
}

/// The caps that spidarmotion accepts; null when the element does not exist.
static GstCaps* motion_caps() {
  const Ref<GstElementFactory> factory(gst_element_factory_find("spidarmotion"));
  if (!factory) return nullptr;
  const GList* pads = gst_element_factory_get_static_pad_templates(factory.get());
  // Both pads have the same template.
  return gst_static_pad_template_get_caps(static_cast<GstStaticPadTemplate*>(pads->data));
}

static GstPad* add_ghost_pad(GstSpidarFeelBin* self, GstElement* element, const char* name) {
  const Ref<GstPad> target(gst_element_get_static_pad(element, name));
  GstPad* pad = gst_ghost_pad_new(name, target.get());
  gst_element_add_pad(GST_ELEMENT(self), pad);
  return pad;
}

GstElement* gst_spidar_feel_bin_new(const char* properties, bool turns) {
  GstCaps* caps = motion_caps();
  GstElement* before = gst_element_factory_make("videoconvert", nullptr);
  GstElement* middle = gst_element_factory_make("capsfilter", nullptr);
  GstElement* after = gst_element_factory_make("videoconvert", nullptr);
  GstElement* result = nullptr;
  if (caps && before && middle && after) {
    auto* self = static_cast<GstSpidarFeelBin*>(g_object_new(GST_TYPE_SPIDAR_FEEL_BIN, nullptr));
    self->properties = g_strdup(properties ? properties : "");
    self->turns = turns;
    self->before = before;
    self->middle = self->in_place = GST_ELEMENT(gst_object_ref_sink(middle));
    self->after = after;
    // Nothing could be drawn into frames in GPU memory.
    if (!is_set(self->properties, "overlay")) caps = gst_caps_merge(spidar::gpu_caps(), caps);
    g_object_set(middle, "caps", caps, nullptr);
    gst_bin_add_many(GST_BIN(self), before, middle, after, nullptr);
    gst_element_link_many(before, middle, after, nullptr);
    const Ref<GstPad> pad(gst_element_get_static_pad(before, "sink"));
    constexpr auto kData =
        static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM |
                                     GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_BUFFER_LIST);
    gst_pad_add_probe(pad.get(), kData, before_data, self, nullptr);
    GstPad* sink = add_ghost_pad(self, before, "sink");
    gst_pad_set_chain_function(sink, chain);
    gst_pad_set_chain_list_function(sink, chain_list);
    add_ghost_pad(self, after, "src");
    result = GST_ELEMENT(self);
  } else {
    gst_clear_object(&before);
    gst_clear_object(&middle);
    gst_clear_object(&after);
    g_printerr(
        "spidar-feel: the elements videoconvert or capsfilter are missing; nothing is felt\n");
  }
  gst_clear_caps(&caps);
  return result;
}
