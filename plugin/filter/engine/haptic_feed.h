// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <mutex>
#include <string>

#include <gst/gst.h>

#include "plugin/device/haptic_output.h"
#include "plugin/filter/touch/relief_stream.h"
#include "plugin/properties/motion_properties.h"
#include "plugin/reasons/no_force.h"
#include "plugin/timing/loop_queue.h"

namespace spidar::filter {

/// The way of an element's wrenches, samples and reliefs to the hand: a device with its queues. The
/// parts can be used in any thread, and so can the functions that concern several of them, except
/// for open() and close().
struct HapticFeed {
  explicit HapticFeed(GstElement* element);

  /// Opens the device, in a state change. Returns an empty string, or why the haptic trace cannot
  /// be written: the device works without. Throws ProfileError, DeviceError, std::runtime_error.
  std::string open(const MotionProperties& properties);
  /// Ramps the motors to zero and closes the device. State changes.
  void close();

  /// Ramps the force to zero at once. It stays there until frames come after set_muted(false).
  void set_muted(bool muted);
  /// Discards all scheduled wrenches at once, and the touched surface.
  void clear();
  /// Tells that the sink shows frames `multiplier` times as fast from now on, see
  /// InstantRate::change().
  void change_rate(double multiplier, GstClockTime running_time, GstClockTime upstream);
  /// Tells that the sink has stepped over `duration` and shows later frames that much earlier.
  void skip(GstClockTime duration);
  /// Tells that running time begins anew.
  void reset();

  // The queues must outlive the output's thread, which forwards their entries.
  WrenchBacklog schedule;
  LoopQueue<TrackBlock> track_samples{kMaxBlocksWaiting};
  NoForceWatch no_force;
  ReliefStream reliefs;
  HapticOutput output;

 private:
  std::mutex skip_mutex_;  ///< skips must reach schedule and output in the same order
};

}  // namespace spidar::filter
