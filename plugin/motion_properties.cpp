#include "plugin/motion_properties.h"

#include "spidar/profile.h"

namespace spidar {
namespace {

GType controller_type() {
  static const GType type = [] {
    static const GEnumValue values[] = {
        {static_cast<int>(ControllerKind::kLinear),
         "Linear: full force at the largest speed seen so far (eq. 11-13)", "linear"},
        {static_cast<int>(ControllerKind::kNonlinear),
         "Nonlinear: arctangent of the speed (eq. 14-15)", "nonlinear"},
        {0, nullptr, nullptr}};
    return g_enum_register_static("GstSpidarMotionController", values);
  }();
  return type;
}

GType motion_type() {
  static const GType type = [] {
    static const GEnumValue values[] = {
        {static_cast<int>(MotionKind::kMean), "Mean velocity of all tracked points (eq. 9-10)",
         "mean"},
        {static_cast<int>(MotionKind::kObject),
         "The dominant object against the background; at rest where only the camera moves",
         "object"},
        {static_cast<int>(MotionKind::kObjects),
         "All objects against the background, weighted by their area", "objects"},
        {static_cast<int>(MotionKind::kCamera), "What the camera does: ride along", "camera"},
        {0, nullptr, nullptr}};
    return g_enum_register_static("GstSpidarMotionMotion", values);
  }();
  return type;
}

GType on_device_error_type() {
  static const GType type = [] {
    static const GEnumValue values[] = {
        {static_cast<int>(OnDeviceError::kWarn),
         "Post a warning, play on, take the device back when it returns", "warn"},
        {static_cast<int>(OnDeviceError::kError), "Post an error and stop", "error"},
        {0, nullptr, nullptr}};
    return g_enum_register_static("GstSpidarMotionOnDeviceError", values);
  }();
  return type;
}

constexpr auto kRead = static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS);
constexpr auto kReadWrite = static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS);
/// Changeable while playing, and by a GstController.
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

MotionProperties::MotionProperties() : profile(kDefaultProfile) {}

void install_motion_properties(GObjectClass* c) {
  const MotionProperties defaults;
  const ControllerSettings& gain = defaults.analyzer.controller;
  const TrackerSettings& tracker = defaults.analyzer.tracker;
  const auto install = [c](PropertyId id, GParamSpec* spec) {
    g_object_class_install_property(c, id, spec);
  };

  install(kPropDevice, g_param_spec_string(
                           "device", "Device",
                           "Haptic device: 'sim' (simulated SPIDAR), a board as of spidarctl list "
                           "('usb', 'usb:ID', 'uart:PATH', 'mouse') or 'none' (analyse only); "
                           "opened from NULL to READY",
                           defaults.device.c_str(), kReady));
  install(kPropProfile, g_param_spec_string(
                            "profile", "Profile",
                            "Geometry and drives of the device: a name of the shipped profiles or "
                            "the path of a .toml file; read from NULL to READY",
                            defaults.profile.c_str(), kReady));
  install(kPropController,
          g_param_spec_enum("controller", "Controller", "How speed becomes force",
                            controller_type(), static_cast<int>(gain.kind), kControllable));
  install(kPropMotion, g_param_spec_enum("motion", "Motion", "Which motion of the picture is felt",
                                         motion_type(), static_cast<int>(defaults.analyzer.motion),
                                         kControllable));
  install(kPropMaxForce, g_param_spec_double("max-force", "Maximum force",
                                             "Largest force on the grip, N (Fmax of eq. 12 and 15)",
                                             0.0, 20.0, gain.max_force_N, kControllable));
  install(kPropAlpha,
          g_param_spec_double("alpha", "Alpha",
                              "Steepness of the nonlinear controller, seconds per pixel of a frame "
                              "480 lines high: half the maximum force is reached at 1/alpha px/s",
                              1e-6, 10.0, gain.alpha_s_px, kControllable));
  install(kPropDepthGain,
          g_param_spec_double("depth-gain", "Depth gain",
                              "Force towards the viewer of what grows: 1 feels a growth like the "
                              "speed that it gives half a frame's height away; 0 is off",
                              0.0, 100.0, defaults.analyzer.axes.depth, kControllable));
  install(kPropRollGain,
          g_param_spec_double("roll-gain", "Roll gain",
                              "Torque about the view axis of what turns: 1 feels a turn like the "
                              "speed that it gives half a frame's height away; 0 is off",
                              0.0, 100.0, defaults.analyzer.axes.roll, kControllable));
  install(kPropMaxFeatures,
          g_param_spec_uint("max-features", "Maximum features", "Points followed at once", 1, 10000,
                            static_cast<guint>(tracker.max_features), kControllable));
  install(kPropQualityLevel,
          g_param_spec_double("quality-level", "Quality level",
                              "Weakest corner that is followed, as a share of the strongest one's "
                              "smaller eigenvalue (Shi-Tomasi)",
                              1e-6, 1.0, tracker.quality_level, kControllable));
  install(kPropMinDistance,
          g_param_spec_double("min-distance", "Minimum distance",
                              "Between two features, in pixels of a frame 480 lines high", 0.0,
                              480.0, tracker.min_distance_px, kControllable));
  install(kPropTsOffset,
          g_param_spec_int64("ts-offset", "Timestamp offset",
                             "Feel the motion later (positive) or earlier (negative) than it is "
                             "shown, ns",
                             -10 * GST_SECOND, 10 * GST_SECOND, 0, kControllable));
  install(
      kPropOnDeviceError,
      g_param_spec_enum("on-device-error", "On device error",
                        "What to do when the device fails while playing", on_device_error_type(),
                        static_cast<int>(defaults.on_device_error), kPlaying));
  install(kPropPostMessages,
          g_param_spec_boolean("post-messages", "Post messages",
                               "Post a 'spidar-motion' element message for each frame",
                               defaults.post_messages, kPlaying));
  install(kPropTrace,
          g_param_spec_string("trace", "Trace",
                              "Write motion and force to this file, CSV with a row a frame; opened "
                              "from READY to PAUSED",
                              nullptr, kReady));
  install(kPropHapticTrace,
          g_param_spec_string("haptic-trace", "Haptic trace",
                              "Write forces, string tensions and pose to this file, CSV with a row "
                              "a millisecond; opened from NULL to READY",
                              nullptr, kReady));
  install(kPropStats,
          g_param_spec_boxed("stats", "Statistics",
                             "Frames, analysis time, state and timing of the haptic loop",
                             GST_TYPE_STRUCTURE, kRead));

  gst_type_mark_as_plugin_api(controller_type(), GST_PLUGIN_API_FLAG_IGNORE_ENUM_MEMBERS);
  gst_type_mark_as_plugin_api(motion_type(), GST_PLUGIN_API_FLAG_IGNORE_ENUM_MEMBERS);
  gst_type_mark_as_plugin_api(on_device_error_type(), GST_PLUGIN_API_FLAG_IGNORE_ENUM_MEMBERS);
}

bool set_motion_property(MotionProperties& p, guint id, const GValue* value) {
  ControllerSettings& gain = p.analyzer.controller;
  TrackerSettings& tracker = p.analyzer.tracker;
  switch (id) {
    case kPropDevice:
      p.device = string_of(value);
      return true;
    case kPropProfile:
      p.profile = string_of(value);
      return true;
    case kPropController:
      gain.kind = static_cast<ControllerKind>(g_value_get_enum(value));
      return true;
    case kPropMotion:
      p.analyzer.motion = static_cast<MotionKind>(g_value_get_enum(value));
      return true;
    case kPropMaxForce:
      gain.max_force_N = g_value_get_double(value);
      return true;
    case kPropAlpha:
      gain.alpha_s_px = g_value_get_double(value);
      return true;
    case kPropDepthGain:
      p.analyzer.axes.depth = g_value_get_double(value);
      return true;
    case kPropRollGain:
      p.analyzer.axes.roll = g_value_get_double(value);
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
    default:
      return false;
  }
}

bool get_motion_property(const MotionProperties& p, guint id, GValue* value) {
  const ControllerSettings& gain = p.analyzer.controller;
  const TrackerSettings& tracker = p.analyzer.tracker;
  switch (id) {
    case kPropDevice:
      g_value_set_string(value, p.device.c_str());
      return true;
    case kPropProfile:
      g_value_set_string(value, p.profile.c_str());
      return true;
    case kPropController:
      g_value_set_enum(value, static_cast<int>(gain.kind));
      return true;
    case kPropMotion:
      g_value_set_enum(value, static_cast<int>(p.analyzer.motion));
      return true;
    case kPropMaxForce:
      g_value_set_double(value, gain.max_force_N);
      return true;
    case kPropAlpha:
      g_value_set_double(value, gain.alpha_s_px);
      return true;
    case kPropDepthGain:
      g_value_set_double(value, p.analyzer.axes.depth);
      return true;
    case kPropRollGain:
      g_value_set_double(value, p.analyzer.axes.roll);
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
    default:
      return false;
  }
}

}  // namespace spidar
