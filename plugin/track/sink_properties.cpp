// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/track/sink_properties.h"

#include "spidar/boards/board_list.h"

namespace spidar {
namespace {

constexpr auto kReadWrite = static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS);
constexpr auto kControllable =
    static_cast<GParamFlags>(kReadWrite | GST_PARAM_CONTROLLABLE | GST_PARAM_MUTABLE_PLAYING);
constexpr auto kPlaying = static_cast<GParamFlags>(kReadWrite | GST_PARAM_MUTABLE_PLAYING);
constexpr auto kReady = static_cast<GParamFlags>(kReadWrite | GST_PARAM_MUTABLE_READY);

std::string string_of(const GValue* value) {
  const char* text = g_value_get_string(value);
  return text ? text : "";
}

}  // namespace

std::string SinkProperties::used_profile() const {
  return profile.empty() ? default_profile(device) : profile;
}

void install_sink_properties(GObjectClass* c) {
  const SinkProperties defaults;
  const auto install = [c](SinkPropertyId id, GParamSpec* spec) {
    g_object_class_install_property(c, id, spec);
  };
  install(
      kSinkDevice,
      g_param_spec_string(
          "device", "Device",
          "Haptic device: 'sim' (simulated SPIDAR) or a board that 'spidarctl list' prints ('usb', "
          "'usb:ID', 'uart:PATH', 'mouse', 'ff'). Opened in the change from NULL to READY",
          defaults.device.c_str(), kReady));
  install(
      kSinkProfile,
      g_param_spec_string(
          "profile", "Profile",
          "Geometry and motors of the device: the name of a shipped profile or the path of a .toml "
          "file. If unset, a profile that fits the board. Read in the change from NULL to READY",
          defaults.used_profile().c_str(), kReady));
  install(kSinkMaxForce,
          g_param_spec_double("max-force", "Maximum force", "Largest force on the grip, in newtons",
                              0.0, 20.0, defaults.max_force_N, kControllable));
  install(kSinkGain,
          g_param_spec_double("gain", "Gain",
                              "Factor on force and torque of the track. A change takes effect "
                              "after the 0.2 s of samples that are already queued",
                              0.0, 100.0, defaults.gain, kControllable));
  install(kSinkMute, g_param_spec_boolean("mute", "Mute",
                                          "While true, no force: it ramps to zero at once, and "
                                          "returns 0.2 s after the property is set to false",
                                          defaults.mute, kControllable));
  install(
      kSinkOnDeviceError,
      g_param_spec_enum("on-device-error", "On device error",
                        "What happens when the device fails while playing", on_device_error_type(),
                        static_cast<int>(defaults.on_device_error), kPlaying));
  install(
      kSinkHapticTrace,
      g_param_spec_string("haptic-trace", "Haptic trace",
                          "Write one CSV line for each millisecond with forces, string tensions "
                          "and pose to this file. Opened in the change from NULL to READY",
                          nullptr, kReady));
  install(
      kSinkStats,
      g_param_spec_boxed(
          "stats", "Statistics",
          "Statistics: samples and their faults, state and timing of the haptic loop",
          GST_TYPE_STRUCTURE, static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS)));
}

bool set_sink_property(SinkProperties& p, guint id, const GValue* value) {
  switch (id) {
    case kSinkDevice:
      p.device = string_of(value);
      return true;
    case kSinkProfile:
      p.profile = string_of(value);
      return true;
    case kSinkMaxForce:
      p.max_force_N = g_value_get_double(value);
      return true;
    case kSinkGain:
      p.gain = g_value_get_double(value);
      return true;
    case kSinkMute:
      p.mute = g_value_get_boolean(value);
      return true;
    case kSinkOnDeviceError:
      p.on_device_error = static_cast<OnDeviceError>(g_value_get_enum(value));
      return true;
    case kSinkHapticTrace:
      p.haptic_trace = string_of(value);
      return true;
    default:
      return false;
  }
}

bool get_sink_property(const SinkProperties& p, guint id, GValue* value) {
  switch (id) {
    case kSinkDevice:
      g_value_set_string(value, p.device.c_str());
      return true;
    case kSinkProfile:
      g_value_set_string(value, p.used_profile().c_str());
      return true;
    case kSinkMaxForce:
      g_value_set_double(value, p.max_force_N);
      return true;
    case kSinkGain:
      g_value_set_double(value, p.gain);
      return true;
    case kSinkMute:
      g_value_set_boolean(value, p.mute);
      return true;
    case kSinkOnDeviceError:
      g_value_set_enum(value, static_cast<int>(p.on_device_error));
      return true;
    case kSinkHapticTrace:
      g_value_set_string(value, p.haptic_trace.empty() ? nullptr : p.haptic_trace.c_str());
      return true;
    default:
      return false;
  }
}

}  // namespace spidar
