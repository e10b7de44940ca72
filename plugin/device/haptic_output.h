// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <gst/gst.h>

#include "core/fields.h"
#include "plugin/device/device_view.h"
#include "plugin/timing/playback_follower.h"
#include "spidar/session/haptic_session.h"

namespace spidar {

class CardReservation;
class SimulatedDevice;

/// The haptic session of an element, and the playback clock that it follows. Thread-safe except for
/// session(), which is for state changes and the streaming thread.
class HapticOutput {
 public:
  /// `refreshed` is called after the haptic loop has received the playback clock: a hundred times a
  /// second while playing.
  HapticOutput(GstElement* element, std::function<void()> refreshed);
  ~HapticOutput();

  /// For tests only; call this before open(). `now` replaces CLOCK_MONOTONIC, the test runs the
  /// ticks of the loop, and each tick advances the device "sim" by a millisecond.
  void set_manual(std::function<int64_t()> now);

  /// Opens the device; `profile` is a name or a path for load_profile(), or empty for the default
  /// profile of the device. Throws ProfileError, std::runtime_error, and DeviceError, also for a
  /// board without a profile, whose motors may get no force; then the device stays closed. Returns
  /// an empty string, or why the haptic trace cannot be written: the device works without the
  /// trace. See set_max_force().
  std::string open(const std::string& device, const std::string& profile, double max_force_N,
                   const std::string& haptic_trace);
  /// The device that "auto" chose, and why; empty for any other name. State changes.
  const std::string& chosen() const { return chosen_; }
  /// other_than_confirmed() of the device. State changes.
  const std::string& doubt() const { return doubt_; }
  /// The limit of the open device. State changes.
  double max_force_N() const { return max_force_N_; }
  /// Begins the haptic trace, once. A file that has rows is overwritten only when there is a film,
  /// so that a mistyped film leaves the file alone. Returns the same as open(), which calls this.
  std::string begin_trace(bool has_film);
  /// Brings the motors to rest and closes the device.
  void close();

  PlaybackFollower& follower() { return follower_; }
  /// Limits the force of the open device from the next tick on. A limit above the force that the
  /// device can exert in every direction is lowered and reported, once for each opened device.
  void set_max_force(double max_force_N);

  /// Null while closed. Opened and closed by state changes only.
  HapticSession* session() const { return session_.get(); }
  /// The device "sim"; null for other devices, and while closed. State changes open and close it.
  SimulatedDevice* simulated() const { return simulated_; }
  /// The profile of the device that is open, or was last open.
  const Profile& profile() const { return profile_; }
  /// Returns nothing while the device is closed.
  std::optional<LoopSnapshot> snapshot() const;
  bool read_device(DeviceView& view);
  /// Leads the hand of the device "sim" to a position, see SimulatedDevice::lead_hand(). Returns
  /// false for other devices, and while closed.
  bool lead_hand(const std::optional<Eigen::Vector3d>& to_m);
  void describe(FieldSink& to) const;

 private:
  std::string open_named(const std::string& device, const std::string& profile, double max_force_N);

  GstElement* const element_;
  const std::function<void()> refreshed_;
  std::function<int64_t()> now_;                  ///< of set_manual(); null: CLOCK_MONOTONIC
  mutable std::mutex mutex_;                      ///< guards what state changes replace
  std::unique_ptr<CardReservation> reservation_;  ///< of the session's card
  std::unique_ptr<HapticSession> session_;
  SimulatedDevice* simulated_ = nullptr;  ///< the device of session_ if it is simulated, else null
  Profile profile_;
  std::string chosen_, doubt_;
  std::string next_trace_;  ///< the file of the trace, until it is opened; empty: none
  double max_force_N_ = 0;
  double most_force_N_ = 0;    ///< the force that the device can exert
  std::string most_force_of_;  ///< the profile, or the device, that sets this limit
  bool said_too_much_ = false;
  PlaybackFollower follower_;  ///< must end before the loop to which it publishes
};

}  // namespace spidar
