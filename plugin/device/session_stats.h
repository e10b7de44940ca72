// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Numbers of a device that is open, for the `stats` property of an element.
#pragma once

#include <gst/gst.h>

#include "spidar/session/haptic_session.h"

namespace spidar {

/// Adds device, device-state, scheduling (string), real-time (boolean), ticks, overruns,
/// exchange-errors, pose-errors, times-lost (uint64), pose-trouble (string: why the pose is not
/// known, 'none' while it is), motor-heat (double: of the warmest motor, 1 is what it may have for
/// ever), held-back (boolean: less force than wanted because a motor is warm or a string is out),
/// held-back-ticks (uint64), faulty-string (int, −1 when none),
/// grip-held (boolean: false when the force rests because nobody holds the grip), grip-speed
/// (double, m/s), vibration-share (double: of the force that is wanted, 1 unless it has shaken the
/// hand for long), vibration-left (double: of the store of VibrationBudget, 0 … 1),
/// touching (boolean), touch-depth-mm, touch-force (double, N), touch-stiffness-share (double: what
/// is left of the stiffness, 1 unless the surface has shaken the grip),
/// wakeup-median, wakeup-p999, skew-median, skew-p99 (uint64, ns; skew: force at the device
/// after its frame was due on the screen), link-fault (string: the last one, see LinkFault),
/// link-timeouts, link-errors (all other faults), link-late-replies (uint64), round-trip-median,
/// round-trip-p99 (uint64, ns; zero for a device without a link).
void describe_session(const HapticSession& session, GstStructure* structure);

}  // namespace spidar
