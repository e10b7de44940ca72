// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The way of an element's wrenches, samples and reliefs to the hand.
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

/// A device with what waits for it. The parts can be used in any thread, and so can the functions
/// that concern several of them, except for open() and close().
struct HapticFeed {
  explicit HapticFeed(GstElement* element);

  /// Opens the device. Returns an empty string, or why the haptic trace cannot be written: the
  /// device works without it. Throws ProfileError, DeviceError, std::runtime_error. State changes.
  std::string open(const MotionProperties& properties);
  /// Brings the motors to rest and closes the device. State changes.
  void close();

  /// The force ramps to rest at once and stays there until frames come after set_muted(false).
  void set_muted(bool muted);
  /// Discards at once what was scheduled, and the surface that can be touched.
  void clear();
  /// From now on, the sink shows frames `multiplier` times as fast, see InstantRate::change().
  void change_rate(double multiplier, GstClockTime running_time, GstClockTime upstream);
  /// The sink has stepped over `duration` of running time and shows later frames that much earlier.
  void skip(GstClockTime duration);
  /// Running time begins anew.
  void reset();

  // They outlive the output's thread, which forwards what waits.
  WrenchBacklog schedule;
  LoopQueue<TrackBlock> track_samples{kMaxBlocksWaiting};
  NoForceWatch no_force;
  ReliefStream reliefs;
  HapticOutput output;

 private:
  std::mutex skip_mutex_;  ///< what is skipped reaches schedule and output in the same order
};

}  // namespace spidar::filter
