// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What an application can set of how motion and force are shown.
#pragma once

#include <gst/gst.h>

namespace spidar {

struct DisplayProperties {
  bool overlay = false;
  double arrow_scale = 4;
  bool debug_window = false;
  bool attach_meta = false;
};

enum DisplayPropertyId : guint {
  kPropOverlay = 100,  ///< after those of MotionProperties
  kPropArrowScale,
  kPropDebugWindow,
  kPropAttachMeta,
};

void install_display_properties(GObjectClass* object_class);

/// False for an id that is none of these.
bool set_display_property(DisplayProperties& properties, guint id, const GValue* value);
bool get_display_property(const DisplayProperties& properties, guint id, GValue* value);

}  // namespace spidar
