// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What an application can set on spidarsink. The words are those of spidarmotion.
#pragma once

#include <string>

#include "plugin/output/device_warnings.h"
#include "plugin/properties/device_rows.h"

namespace spidar {

struct SinkProperties {
  std::string device = "sim";
  std::string profile;  ///< empty: that of the device's board
  double max_force_N = 3;
  double gain = 1;
  bool mute = false;
  bool post_messages = true;
  bool accept_unmarked = false;
  OnDeviceError on_device_error = OnDeviceError::kWarn;
  std::string haptic_trace;
};

/// All of spidarsink, `stats` included; `ts-offset` is that of every sink.
inline const PropertyTable<SinkProperties>& sink_properties() {
  using SinkRow = Property<SinkProperties>;
  // Never destroyed: a thread may still set a property while the process ends.
  static const auto& table = *new PropertyTable<SinkProperties>{{
      SinkRow::text({"device", "Device",
                     "Haptic device: 'sim' (simulated SPIDAR), one that 'spidarctl list' prints, "
                     "or 'auto' (what is plugged in). Opened from NULL to READY"},
                    kNull, KEPT_IN(device)),
      profile_row<SinkProperties>(),
      SinkRow::number({"max-force", "Maximum force", "Largest force on the grip, in newtons"}, 0,
                      20, kControllable, KEPT_IN(max_force_N)),
      SinkRow::number(
          {"gain", "Gain",
           "Factor on force and torque of the track. A change takes effect after the 0.2 s "
           "of samples that are already queued"},
          0, 100, kControllable, KEPT_IN(gain)),
      SinkRow::on_off(
          {"mute", "Mute",
           "While true, no force: it ramps to zero at once, and returns 0.2 s after the "
           "property is set to false"},
          kControllable, KEPT_IN(mute)),
      SinkRow::on_off(
          {"post-messages", "Post messages",
           "Post a 'spidar-motion' element message for each 40 ms of the track, as long as fewer "
           "than 1000 of them wait on the bus"},
          kPlaying, KEPT_IN(post_messages)),
      SinkRow::on_off(
          {"accept-unmarked", "Accept unmarked",
           "Feel sound of six channels that nothing marks as a haptic track. Tracks that "
           "spidarextract and spidartrack make are marked by a tag; other sound is not felt"},
          kReady, KEPT_IN(accept_unmarked)),
      on_device_error_row<SinkProperties>(),
      haptic_trace_row<SinkProperties>(),
      SinkRow::statistics({"stats", "Statistics",
                           "Statistics: samples and their faults, state and timing of the haptic "
                           "loop"}),
  }};
  return table;
}

}  // namespace spidar
