// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/frame/motion_message.h"

#include "plugin/frame/frame_fields.h"
#include "plugin/gobject/bus_messages.h"
#include "plugin/gobject/structure_fields.h"

namespace spidar {

void post_motion_message(GstElement* element, GstClockTime timestamp, GstClockTime duration,
                         const FrameReport& report, gint* unread) {
  if (is_full_of_unread(*unread)) return;
  GstStructure* const structure = gst_structure_new_empty("spidar-motion");
  StructureFields to(structure, kInMessage);
  frame_fields(report, {timestamp, duration}, to);
  post_counted(element, gst_message_new_element(GST_OBJECT(element), structure), *unread);
}

}  // namespace spidar
