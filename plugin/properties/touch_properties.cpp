// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/properties/touch_properties.h"

#include "core/touch/contact_force.h"

namespace spidar {
namespace {

/// Can be changed while playing, and controlled by a GstController.
constexpr auto kControllable =
    static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | GST_PARAM_CONTROLLABLE |
                             GST_PARAM_MUTABLE_PLAYING);
constexpr double kMostRelief_mm = 30;
constexpr double kLeastStiffness_N_m = 10;
constexpr double kMostTexture = 10;

GType touch_type() {
  static const GType type = [] {
    static const GEnumValue values[] = {
        {static_cast<int>(TouchKind::kOff), "No surface: the motion of the film is felt", "off"},
        {static_cast<int>(TouchKind::kLuma), "A relief of the frame's brightness: bright is near",
         "luma"},
        {static_cast<int>(TouchKind::kDepth), "A relief of the frame's depth, see depth-layout",
         "depth"},
        {0, nullptr, nullptr}};
    return g_enum_register_static("GstSpidarMotionTouch", values);
  }();
  return type;
}

GType depth_layout_type() {
  static const GType type = [] {
    static const GEnumValue values[] = {
        {static_cast<int>(DepthSource::kMeta), "A depth image that spidardepth has attached",
         "meta"},
        {static_cast<int>(DepthSource::kRight),
         "The right half of the frame is the depth of the left half; bright is near", "right"},
        {static_cast<int>(DepthSource::kBelow),
         "The lower half of the frame is the depth of the upper half; bright is near", "below"},
        {0, nullptr, nullptr}};
    return g_enum_register_static("GstSpidarMotionDepthLayout", values);
  }();
  return type;
}

}  // namespace

std::optional<DepthLayout> packed_layout(DepthSource source) {
  switch (source) {
    case DepthSource::kRight:
      return DepthLayout::kRight;
    case DepthSource::kBelow:
      return DepthLayout::kBelow;
    case DepthSource::kMeta:
      break;
  }
  return std::nullopt;
}

void install_touch_properties(GObjectClass* c) {
  const TouchProperties defaults;
  const auto install = [c](TouchPropertyId id, GParamSpec* spec) {
    g_object_class_install_property(c, id, spec);
  };
  install(kPropTouch,
          g_param_spec_enum("touch", "Touch", "Which surface the grip touches in the picture",
                            touch_type(), static_cast<int>(defaults.kind), kControllable));
  install(kPropDepthLayout,
          g_param_spec_enum("depth-layout", "Depth layout", "Where touch=depth finds the depth",
                            depth_layout_type(), static_cast<int>(defaults.depth), kControllable));
  install(kPropTouchRelief,
          g_param_spec_double("touch-relief", "Touch relief",
                              "Height of the relief from black to white, or from far to near, in "
                              "millimetres. Its middle is in the centre of the workspace",
                              0, kMostRelief_mm, defaults.relief_mm, kControllable));
  install(kPropTouchStiffness,
          g_param_spec_double("touch-stiffness", "Touch stiffness",
                              "Stiffness of the surface, in newtons per metre. A device with slow "
                              "drives gets less, with a warning",
                              kLeastStiffness_N_m, ContactSettings::kMostStiffness_N_m,
                              defaults.stiffness_N_m, kControllable));
  install(kPropTouchFriction, g_param_spec_double("touch-friction", "Touch friction",
                                                  "Coefficient of static friction of the surface; "
                                                  "that of kinetic friction is four fifths of it",
                                                  0, 1, defaults.friction, kControllable));
  install(kPropTouchTexture,
          g_param_spec_double("touch-texture", "Touch texture",
                              "Lateral force of the picture's fine detail, as a multiple of the "
                              "slope that it has in the relief; 0 turns it off",
                              0, kMostTexture, defaults.texture, kControllable));
  install(kPropMotionShare,
          g_param_spec_double("motion-share", "Motion share",
                              "With touch, the share of the force of the film's motion that is "
                              "added to the contact force. Without touch, all of it is felt",
                              0, 1, defaults.motion_share, kControllable));
  for (const GType type : {touch_type(), depth_layout_type()})
    gst_type_mark_as_plugin_api(type, GST_PLUGIN_API_FLAG_IGNORE_ENUM_MEMBERS);
}

bool set_touch_property(TouchProperties& p, guint id, const GValue* value) {
  switch (id) {
    case kPropTouch:
      p.kind = static_cast<TouchKind>(g_value_get_enum(value));
      return true;
    case kPropDepthLayout:
      p.depth = static_cast<DepthSource>(g_value_get_enum(value));
      return true;
    case kPropTouchRelief:
      p.relief_mm = g_value_get_double(value);
      return true;
    case kPropTouchStiffness:
      p.stiffness_N_m = g_value_get_double(value);
      return true;
    case kPropTouchFriction:
      p.friction = g_value_get_double(value);
      return true;
    case kPropTouchTexture:
      p.texture = g_value_get_double(value);
      return true;
    case kPropMotionShare:
      p.motion_share = g_value_get_double(value);
      return true;
    default:
      return false;
  }
}

bool get_touch_property(const TouchProperties& p, guint id, GValue* value) {
  switch (id) {
    case kPropTouch:
      g_value_set_enum(value, static_cast<int>(p.kind));
      return true;
    case kPropDepthLayout:
      g_value_set_enum(value, static_cast<int>(p.depth));
      return true;
    case kPropTouchRelief:
      g_value_set_double(value, p.relief_mm);
      return true;
    case kPropTouchStiffness:
      g_value_set_double(value, p.stiffness_N_m);
      return true;
    case kPropTouchFriction:
      g_value_set_double(value, p.friction);
      return true;
    case kPropTouchTexture:
      g_value_set_double(value, p.texture);
      return true;
    case kPropMotionShare:
      g_value_set_double(value, p.motion_share);
      return true;
    default:
      return false;
  }
}

}  // namespace spidar
