// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The report of a frame, or of a piece of a haptic track, as a message on the bus.
#pragma once

#include <Eigen/Core>
#include <gst/gst.h>

#include "core/wrench.h"
#include "plugin/frame/frame_report.h"
#include "plugin/output/no_force.h"

namespace spidar {

/// Adds velocity-x and -y, force-x to -z and torque-x to -z (doubles).
void set_motion(GstStructure* structure, const Eigen::Vector2d& velocity_px_s,
                const Wrench& wrench);

/// Adds area-x, -y, -width and -height (uints): the part of the frame that the film is in.
void set_area(GstStructure* structure, const PicturePart& film);

/// Adds no-force-reason and device-no-force-reason (strings, see nick()), and no-force-text and
/// device-no-force-text (strings: a sentence, empty for "none").
void describe_no_force(NoForceReason film, NoForceReason device, GstStructure* structure);

/// Posts `spidar-motion`, whose fields the documentation of the element lists; see post_counted().
void post_motion_message(GstElement* element, GstClockTime timestamp, GstClockTime duration,
                         const FrameReport& report, gint* unread);

}  // namespace spidar
