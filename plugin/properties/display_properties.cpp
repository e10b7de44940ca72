// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/properties/display_properties.h"

namespace spidar {
namespace {

constexpr auto kPlaying = static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS |
                                                   GST_PARAM_MUTABLE_PLAYING);
constexpr auto kControllable = static_cast<GParamFlags>(kPlaying | GST_PARAM_CONTROLLABLE);

}  // namespace

void install_display_properties(GObjectClass* c) {
  const DisplayProperties defaults;
  g_object_class_install_property(
      c, kPropOverlay,
      g_param_spec_boolean("overlay", "Overlay",
                           "Draw tracks and force as arrows into the video. Frames that other "
                           "elements hold are copied first",
                           defaults.overlay, kPlaying));
  g_object_class_install_property(
      c, kPropArrowScale,
      g_param_spec_double("arrow-scale", "Arrow scale",
                          "Length of a track's arrow, as a multiple of the point's displacement "
                          "since the previous frame",
                          0.1, 100.0, defaults.arrow_scale, kControllable));
  g_object_class_install_property(
      c, kPropDebugWindow,
      g_param_spec_boolean("debug-window", "Debug window",
                           "Show picture, tracks, grip, tensions and settings in a window. Becomes "
                           "false when the user closes the window",
                           defaults.debug_window, kPlaying));
  g_object_class_install_property(
      c, kPropAttachMeta,
      g_param_spec_boolean("attach-meta", "Attach meta",
                           "Attach a GstSpidarMotionMeta with motion, tracks and wrench to each "
                           "frame. The picture is neither copied nor changed",
                           defaults.attach_meta, kPlaying));
}

bool set_display_property(DisplayProperties& p, guint id, const GValue* value) {
  switch (id) {
    case kPropOverlay:
      p.overlay = g_value_get_boolean(value);
      return true;
    case kPropArrowScale:
      p.arrow_scale = g_value_get_double(value);
      return true;
    case kPropDebugWindow:
      p.debug_window = g_value_get_boolean(value);
      return true;
    case kPropAttachMeta:
      p.attach_meta = g_value_get_boolean(value);
      return true;
    default:
      return false;
  }
}

bool get_display_property(const DisplayProperties& p, guint id, GValue* value) {
  switch (id) {
    case kPropOverlay:
      g_value_set_boolean(value, p.overlay);
      return true;
    case kPropArrowScale:
      g_value_set_double(value, p.arrow_scale);
      return true;
    case kPropDebugWindow:
      g_value_set_boolean(value, p.debug_window);
      return true;
    case kPropAttachMeta:
      g_value_set_boolean(value, p.attach_meta);
      return true;
    default:
      return false;
  }
}

}  // namespace spidar
