// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The fields of a frame, or of a piece of a haptic track, that users read. To add a field, add a
/// row with its value and its outputs to frame_fields().
#pragma once

#include <cstdint>

#include <gst/gst.h>

#include "core/fields.h"
#include "plugin/frame/frame_report.h"
#include "plugin/gobject/unread_messages.h"
#include "plugin/reasons/no_force.h"

namespace spidar {

enum FrameOutput : unsigned { kInMessage = 1, kInMeta = 2, kInCsv = 4, kInJson = 8 };

/// The buffer of the frame, for the message, and the size of its picture, for the meta.
struct FrameBuffer {
  uint64_t timestamp = 0, duration = 0;
  uint32_t width = 0, height = 0;
};

void frame_fields(const FrameReport& report, const FrameBuffer& buffer, FieldSink& to);

/// The part of the frame that shows the film; also in `stats`.
void area_fields(const PicturePart& film, FieldSink& to);
/// Why nothing is felt; also in `stats`.
void no_force_fields(NoForceReason film, NoForceReason device, FieldSink& to);

// For JSON only.
void background_fields(const Background& background, FieldSink& to);
void object_fields(const MovingObject& object, FieldSink& to);

void post_motion_message(GstElement* element, GstClockTime timestamp, GstClockTime duration,
                         const FrameReport& report, UnreadMessages& unread);

}  // namespace spidar
