// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/properties/motion_properties.h"

#include "plugin/properties/feel_properties.h"
#include "spidar/boards/board_list.h"

namespace spidar {
namespace {

GType quality_type() {
  static const GType type = [] {
    static const GEnumValue values[] = {
        {static_cast<int>(TrackerQuality::kFast),
         "Only in the reduced picture: least time, largest error", "fast"},
        {static_cast<int>(TrackerQuality::kBalanced), "Refined in the frame", "balanced"},
        {static_cast<int>(TrackerQuality::kFine), "More points", "fine"},
        {0, nullptr, nullptr}};
    return g_enum_register_static("GstSpidarMotionQuality", values);
  }();
  return type;
}

constexpr auto kRead = static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS);
constexpr auto kReadWrite = static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS);
/// Can be changed while playing, and controlled by a GstController.
constexpr auto kControllable =
    static_cast<GParamFlags>(kReadWrite | GST_PARAM_CONTROLLABLE | GST_PARAM_MUTABLE_PLAYING);
constexpr auto kPlaying = static_cast<GParamFlags>(kReadWrite | GST_PARAM_MUTABLE_PLAYING);
constexpr auto kReady = static_cast<GParamFlags>(kReadWrite | GST_PARAM_MUTABLE_READY);

const char* or_null(const std::string& text) {
  return text.empty() ? nullptr : text.c_str();
}

std::string string_of(const GValue* value) {
  const char* text = g_value_get_string(value);
  return text ? text : "";
}

}  // namespace

GType on_device_error_type() {
  static const GType type = [] {
    static const GEnumValue values[] = {
        {static_cast<int>(OnDeviceError::kWarn),
         "Post a warning, continue the video, and reopen the device when it returns", "warn"},
        {static_cast<int>(OnDeviceError::kError), "Post an error, which stops the pipeline",
         "error"},
        {0, nullptr, nullptr}};
    return g_enum_register_static("GstSpidarMotionOnDeviceError", values);
  }();
  return type;
}

std::string MotionProperties::used_profile() const {
  return profile.empty() ? default_profile(device) : profile;
}

void install_motion_properties(GObjectClass* c) {
  const MotionProperties defaults;
  const TrackerSettings& tracker = defaults.analyzer.tracker;
  const auto install = [c](PropertyId id, GParamSpec* spec) {
    g_object_class_install_property(c, id, spec);
  };

  install(kPropDevice, g_param_spec_string(
                           "device", "Device",
                           "Haptic device: 'sim' (simulated SPIDAR), a board that 'spidarctl "
                           "list' prints ('usb', 'usb:ID', 'uart:PATH', 'mouse', 'ff'), or 'none' "
                           "(analysis only). Opened in the change from NULL to READY",
                           defaults.device.c_str(), kReady));
  install(
      kPropProfile,
      g_param_spec_string(
          "profile", "Profile",
          "Geometry and motors of the device: the name of a shipped profile or the path of a .toml "
          "file. If unset, a profile that fits the board. Read in the change from NULL to READY",
          defaults.used_profile().c_str(), kReady));
  install_feel_properties(c);
  install(kPropQuality,
          g_param_spec_enum("quality", "Quality",
                            "Trade-off between computing time and error of the points that refine "
                            "the motion of blocks; no effect with motion=mean",
                            quality_type(), static_cast<int>(tracker.quality), kControllable));
  install(kPropMaxFeatures,
          g_param_spec_uint("max-features", "Maximum features",
                            "Largest number of points that are tracked at once", 1, 10000,
                            static_cast<guint>(tracker.max_features), kControllable));
  install(kPropQualityLevel,
          g_param_spec_double("quality-level", "Quality level",
                              "With motion=mean: weakest corner that is tracked, as a share of the "
                              "strongest corner's smaller eigenvalue (Shi-Tomasi)",
                              1e-6, 1.0, tracker.quality_level, kControllable));
  install(
      kPropMinDistance,
      g_param_spec_double(
          "min-distance", "Minimum distance",
          "With motion=mean: smallest distance between two tracked points, in pixels of a frame "
          "480 lines high",
          0.0, 480.0, tracker.min_distance_px, kControllable));
  install(kPropTsOffset, g_param_spec_int64("ts-offset", "Timestamp offset",
                                            "Render the force later (positive) or earlier "
                                            "(negative) than the frame is shown, in nanoseconds",
                                            -10 * GST_SECOND, 10 * GST_SECOND, 0, kControllable));
  install(
      kPropOnDeviceError,
      g_param_spec_enum("on-device-error", "On device error",
                        "What happens when the device fails while playing", on_device_error_type(),
                        static_cast<int>(defaults.on_device_error), kPlaying));
  install(kPropPostMessages,
          g_param_spec_boolean("post-messages", "Post messages",
                               "Post a 'spidar-motion' element message for each frame, as long as "
                               "fewer than 1000 of them wait on the bus",
                               defaults.post_messages, kPlaying));
  install(kPropTrace,
          g_param_spec_string("trace", "Trace",
                              "Write one line for each frame with motion and force to this file: "
                              "CSV, or JSON with background and objects if the name ends in "
                              ".jsonl. Opened in the change from READY to PAUSED",
                              nullptr, kReady));
  install(
      kPropHapticTrace,
      g_param_spec_string("haptic-trace", "Haptic trace",
                          "Write one CSV line for each millisecond with forces, string tensions "
                          "and pose to this file. Opened in the change from NULL to READY",
                          nullptr, kReady));
  install(kPropMute,
          g_param_spec_boolean("mute", "Mute",
                               "While true, no force: it ramps to zero at once, and returns with "
                               "the next frame after the property is set to false",
                               defaults.mute, kControllable));
  install(kPropTrack, g_param_spec_string(
                          "track", "Track",
                          "Play this haptic track by stream time instead of analysing frames: "
                          "a file, or 'auto' for the one beside the film (FILM.mp4.haptic.flac, "
                          ".mka or .wav). Read with the first frame of a stream",
                          nullptr, kReady));
  install_touch_properties(c);
  install_display_properties(c);
  install(kPropStats, g_param_spec_boxed(
                          "stats", "Statistics",
                          "Statistics: frames, analysis time, state and timing of the haptic loop",
                          GST_TYPE_STRUCTURE, kRead));

  gst_type_mark_as_plugin_api(quality_type(), GST_PLUGIN_API_FLAG_IGNORE_ENUM_MEMBERS);
  gst_type_mark_as_plugin_api(on_device_error_type(), GST_PLUGIN_API_FLAG_IGNORE_ENUM_MEMBERS);
}

bool set_motion_property(MotionProperties& p, guint id, const GValue* value) {
  TrackerSettings& tracker = p.analyzer.tracker;
  switch (id) {
    case kPropDevice:
      p.device = string_of(value);
      return true;
    case kPropProfile:
      p.profile = string_of(value);
      return true;
    case kPropQuality:
      tracker.quality = static_cast<TrackerQuality>(g_value_get_enum(value));
      return true;
    case kPropMaxFeatures:
      tracker.max_features = static_cast<int>(g_value_get_uint(value));
      return true;
    case kPropQualityLevel:
      tracker.quality_level = g_value_get_double(value);
      return true;
    case kPropMinDistance:
      tracker.min_distance_px = g_value_get_double(value);
      return true;
    case kPropTsOffset:
      p.ts_offset_ns = g_value_get_int64(value);
      return true;
    case kPropOnDeviceError:
      p.on_device_error = static_cast<OnDeviceError>(g_value_get_enum(value));
      return true;
    case kPropPostMessages:
      p.post_messages = g_value_get_boolean(value);
      return true;
    case kPropTrace:
      p.trace = string_of(value);
      return true;
    case kPropHapticTrace:
      p.haptic_trace = string_of(value);
      return true;
    case kPropMute:
      p.mute = g_value_get_boolean(value);
      return true;
    case kPropTrack:
      p.track = string_of(value);
      return true;
    default:
      return set_feel_property(p, id, value) || set_display_property(p.display, id, value) ||
             set_touch_property(p.touch, id, value);
  }
}

bool get_motion_property(const MotionProperties& p, guint id, GValue* value) {
  const TrackerSettings& tracker = p.analyzer.tracker;
  switch (id) {
    case kPropDevice:
      g_value_set_string(value, p.device.c_str());
      return true;
    case kPropProfile:
      g_value_set_string(value, p.used_profile().c_str());
      return true;
    case kPropQuality:
      g_value_set_enum(value, static_cast<int>(tracker.quality));
      return true;
    case kPropMaxFeatures:
      g_value_set_uint(value, static_cast<guint>(tracker.max_features));
      return true;
    case kPropQualityLevel:
      g_value_set_double(value, tracker.quality_level);
      return true;
    case kPropMinDistance:
      g_value_set_double(value, tracker.min_distance_px);
      return true;
    case kPropTsOffset:
      g_value_set_int64(value, p.ts_offset_ns);
      return true;
    case kPropOnDeviceError:
      g_value_set_enum(value, static_cast<int>(p.on_device_error));
      return true;
    case kPropPostMessages:
      g_value_set_boolean(value, p.post_messages);
      return true;
    case kPropTrace:
      g_value_set_string(value, or_null(p.trace));
      return true;
    case kPropHapticTrace:
      g_value_set_string(value, or_null(p.haptic_trace));
      return true;
    case kPropMute:
      g_value_set_boolean(value, p.mute);
      return true;
    case kPropTrack:
      g_value_set_string(value, or_null(p.track));
      return true;
    default:
      return get_feel_property(p, id, value) || get_display_property(p.display, id, value) ||
             get_touch_property(p.touch, id, value);
  }
}

}  // namespace spidar
