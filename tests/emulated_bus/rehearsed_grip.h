// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A simulated grip on the strings of an emulated board, in a hand that a person directs.
#pragma once

#include <array>
#include <cstdint>

#include "spidar/devices/sim/simulated_device.h"
#include "spidar/link/board_parts.h"
#include "spidar/profiles/profile.h"
#include "tests/emulated_bus/bus_state.h"

namespace spidar::test {

class RehearsedGrip {
 public:
  RehearsedGrip(const Profile& profile, const boards::DacScale& dac);
  ~RehearsedGrip();
  RehearsedGrip(const RehearsedGrip&) = delete;
  RehearsedGrip& operator=(const RehearsedGrip&) = delete;

  /// Moves on to the present: the motors pull as the board in `port` has put out, and its counters
  /// follow the strings. They begin at zero when it gets power.
  void follow(UsbPort& port, Rehearsal& rehearsal);

 private:
  /// How fast a motor winds up the loose end of a string. No source: a real one without a load may
  /// be faster.
  static constexpr double kWinds_m_s = 0.5;

  void lead_hand(const Rehearsal& rehearsal, int64_t now_ns);
  void tell_arrival(Rehearsal& rehearsal);

  const Profile profile_;
  const boards::DacScale dac_;
  SimulatedDevice device_;
  int64_t now_ns_ = 0;    ///< of the simulation
  int64_t began_ns_ = 0;  ///< moving about
  int64_t still_ns_ = 0;  ///< since when the grip stands still
  int moves_ = 0;         ///< Rehearsal::moves before that
  int restarts_ = 0;      ///< Rehearsal::restarts when the counters began at zero_
  std::array<int32_t, kMaxStrings> zero_{};
  std::array<double, kMaxStrings> wound_m_{};
};

}  // namespace spidar::test
