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

/// The path of an element's wrenches, samples and reliefs to the hand: a device and its queues. All
/// members can be used in any thread, except for open() and close().
struct HapticFeed {
  explicit HapticFeed(GstElement* element);

  /// Opens the device, in a state change. Returns an empty string, or why the haptic trace cannot
  /// be written, which does not stop the device. Throws ProfileError, DeviceError, runtime_error.
  std::string open(const MotionProperties& properties);
  /// Ramps the motors to zero and closes the device, in a state change.
  void close();

  /// Starts the ramp of the force to zero, or lets the force return with the frames that follow.
  void set_muted(bool muted);
  /// Discards all scheduled wrenches at once, and the touched surface.
  void clear();
  /// Call this when the sink begins to show frames `multiplier` times as fast, see
  /// InstantRate::change().
  void change_rate(double multiplier, GstClockTime running_time, GstClockTime upstream);
  /// Call this when the sink has skipped `duration` and so shows later frames that much earlier.
  void skip(GstClockTime duration);
  /// Call this when running time restarts.
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
