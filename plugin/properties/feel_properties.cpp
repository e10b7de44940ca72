// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/properties/feel_properties.h"

namespace spidar {
namespace {

/// Can be changed while playing, and controlled by a GstController.
constexpr auto kControllable =
    static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | GST_PARAM_CONTROLLABLE |
                             GST_PARAM_MUTABLE_PLAYING);

GType controller_type() {
  static const GType type = [] {
    static const GEnumValue values[] = {
        {static_cast<int>(ControllerKind::kLinear),
         "Linear: full force at the largest speed so far (eq. 11-13)", "linear"},
        {static_cast<int>(ControllerKind::kNonlinear),
         "Nonlinear: arctangent of the speed (eq. 14-15)", "nonlinear"},
        {static_cast<int>(ControllerKind::kAdaptive),
         "Adaptive: nonlinear, with an alpha that follows the speeds of the scene (a tenth to ten "
         "times the one that is set) and no force below the measurement's noise",
         "adaptive"},
        {0, nullptr, nullptr}};
    return g_enum_register_static("GstSpidarMotionController", values);
  }();
  return type;
}

GType motion_type() {
  static const GType type = [] {
    static const GEnumValue values[] = {
        {static_cast<int>(MotionKind::kMean),
         "Mean velocity of OpenCV's Shi-Tomasi points, tracked by pyramidal Lucas-Kanade: closest "
         "to the paper (eq. 1-10)",
         "mean"},
        {static_cast<int>(MotionKind::kObject),
         "The dominant object relative to the background; no force when only the camera moves",
         "object"},
        {static_cast<int>(MotionKind::kObjects),
         "All objects relative to the background, weighted by area and by distance from the "
         "pointer",
         "objects"},
        {static_cast<int>(MotionKind::kCamera),
         "The motion of the camera, as if the viewer moved with it", "camera"},
        {0, nullptr, nullptr}};
    return g_enum_register_static("GstSpidarMotionMotion", values);
  }();
  return type;
}

GType pointer_type() {
  static const GType type = [] {
    static const GEnumValue values[] = {
        {static_cast<int>(PointerKind::kFixed), "At pointer-x, pointer-y", "fixed"},
        {static_cast<int>(PointerKind::kGrip),
         "Position of the grip; half of the way to the strings' exits is the edge of the picture",
         "grip"},
        {0, nullptr, nullptr}};
    return g_enum_register_static("GstSpidarMotionPointer", values);
  }();
  return type;
}

}  // namespace

void install_feel_properties(GObjectClass* c) {
  const MotionProperties defaults;
  const ControllerSettings& gain = defaults.analyzer.controller;
  const FilterSettings& filter = defaults.analyzer.filter;
  const auto install = [c](PropertyId id, GParamSpec* spec) {
    g_object_class_install_property(c, id, spec);
  };

  install(kPropController,
          g_param_spec_enum("controller", "Controller", "How speed is converted to force",
                            controller_type(), static_cast<int>(gain.kind), kControllable));
  install(
      kPropMotion,
      g_param_spec_enum("motion", "Motion", "Which motion in the picture is rendered as force",
                        motion_type(), static_cast<int>(defaults.analyzer.motion), kControllable));
  install(kPropPointer,
          g_param_spec_enum("pointer", "Pointer",
                            "Which position weights the objects of motion=objects", pointer_type(),
                            static_cast<int>(defaults.pointer), kControllable));
  install(kPropPointerX, g_param_spec_double(
                             "pointer-x", "Pointer x",
                             "Horizontal position of the pointer: 0 is the left edge of the "
                             "picture, 1 the right edge. pointer=grip uses it while no device runs",
                             0.0, 1.0, defaults.analyzer.pointer.x(), kControllable));
  install(kPropPointerY,
          g_param_spec_double(
              "pointer-y", "Pointer y",
              "Vertical position of the pointer: 0 is the top of the picture, 1 the bottom", 0.0,
              1.0, defaults.analyzer.pointer.y(), kControllable));
  install(kPropMaxForce,
          g_param_spec_double("max-force", "Maximum force",
                              "Largest force on the grip, in newtons (Fmax of eq. 12 and 15)", 0.0,
                              20.0, gain.max_force_N, kControllable));
  install(
      kPropAlpha,
      g_param_spec_double(
          "alpha", "Alpha",
          "How quickly force rises with speed (nonlinear and adaptive controller), in seconds per "
          "pixel of a frame 480 lines high: half of the maximum force is reached at 1/alpha px/s",
          1e-6, 10.0, gain.alpha_s_px, kControllable));
  install(kPropDepthGain,
          g_param_spec_double(
              "depth-gain", "Depth gain",
              "Force towards the viewer when the object grows. With 1, growth counts as the speed "
              "that it causes at half a frame's height from the centre; 0 turns it off",
              0.0, 100.0, defaults.analyzer.axes.depth, kControllable));
  install(kPropRollGain,
          g_param_spec_double(
              "roll-gain", "Roll gain",
              "Torque about the view axis when the object turns. With 1, rotation counts as the "
              "speed that it causes at half a frame's height from the centre; 0 turns it off",
              0.0, 100.0, defaults.analyzer.axes.roll, kControllable));
  install(
      kPropFilterMinCutoff,
      g_param_spec_double(
          "filter-min-cutoff", "Filter minimum cutoff",
          "Cutoff frequency of the motion's One-Euro filter while the motion is steady, in Hz. "
          "Lower values are smoother and delay by 1/(2 pi cutoff) seconds; 0 turns the filter off",
          0.0, 1000.0, filter.min_cutoff_Hz, kControllable));
  install(kPropFilterBeta,
          g_param_spec_double("filter-beta", "Filter beta",
                              "How much the One-Euro filter's cutoff rises with the motion's rate "
                              "of change, in Hz per px/s^2 of a frame 480 lines high",
                              0.0, 10.0, filter.beta_s_px, kControllable));

  gst_type_mark_as_plugin_api(controller_type(), GST_PLUGIN_API_FLAG_IGNORE_ENUM_MEMBERS);
  gst_type_mark_as_plugin_api(motion_type(), GST_PLUGIN_API_FLAG_IGNORE_ENUM_MEMBERS);
  gst_type_mark_as_plugin_api(pointer_type(), GST_PLUGIN_API_FLAG_IGNORE_ENUM_MEMBERS);
}

bool set_feel_property(MotionProperties& p, guint id, const GValue* value) {
  ControllerSettings& gain = p.analyzer.controller;
  switch (id) {
    case kPropController:
      gain.kind = static_cast<ControllerKind>(g_value_get_enum(value));
      return true;
    case kPropMotion:
      p.analyzer.motion = static_cast<MotionKind>(g_value_get_enum(value));
      return true;
    case kPropPointer:
      p.pointer = static_cast<PointerKind>(g_value_get_enum(value));
      return true;
    case kPropPointerX:
      p.analyzer.pointer.x() = g_value_get_double(value);
      return true;
    case kPropPointerY:
      p.analyzer.pointer.y() = g_value_get_double(value);
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
    case kPropFilterMinCutoff:
      p.analyzer.filter.min_cutoff_Hz = g_value_get_double(value);
      return true;
    case kPropFilterBeta:
      p.analyzer.filter.beta_s_px = g_value_get_double(value);
      return true;
    default:
      return false;
  }
}

bool get_feel_property(const MotionProperties& p, guint id, GValue* value) {
  const ControllerSettings& gain = p.analyzer.controller;
  switch (id) {
    case kPropController:
      g_value_set_enum(value, static_cast<int>(gain.kind));
      return true;
    case kPropMotion:
      g_value_set_enum(value, static_cast<int>(p.analyzer.motion));
      return true;
    case kPropPointer:
      g_value_set_enum(value, static_cast<int>(p.pointer));
      return true;
    case kPropPointerX:
      g_value_set_double(value, p.analyzer.pointer.x());
      return true;
    case kPropPointerY:
      g_value_set_double(value, p.analyzer.pointer.y());
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
    case kPropFilterMinCutoff:
      g_value_set_double(value, p.analyzer.filter.min_cutoff_Hz);
      return true;
    case kPropFilterBeta:
      g_value_set_double(value, p.analyzer.filter.beta_s_px);
      return true;
    default:
      return false;
  }
}

}  // namespace spidar
