// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "core/grip/pose_solver.h"
#include "core/grip/string_geometry.h"
#include "core/wrench.h"
#include "spidar/chain/tension_chain.h"
#include "spidar/device.h"
#include "spidar/grip/grip.h"
#include "spidar/grip/pose_trust.h"
#include "spidar/grip/reading_gate.h"
#include "spidar/profiles/encoder_scale.h"
#include "spidar/profiles/profile.h"

namespace spidar {

/// Tracks the pose from the encoder counts. The structure matrix may only be used while trusted():
/// tensions that give a wrench at one pose give a different wrench at another. Neither allocates
/// nor throws after construction.
class GripWatch {
 public:
  /// The largest accepted rotation: strings from all sides would have tangled long before.
  static constexpr double kMaxTurn_rad = 2.1;
  /// If no counter has moved for kFrozenAfter_s since the force changed by kFrozenForce_N, the
  /// counters do not work; after a smaller change the time is longer in proportion. When the force
  /// changes by kFrozenForce_N, a hand yields by some millimetres, which is many counts of some
  /// hundredths of a millimetre. When the force changes by kFeltForce_N, the least that a hand
  /// feels, the hand yields by more than a tenth of a millimetre, as much as its tremor. Changes
  /// below that prove nothing, because friction may hold a grip against them.
  static constexpr double kFrozenForce_N = 0.5;
  static constexpr double kFrozenAfter_s = 0.5;

  /// Throws std::invalid_argument when the profile has fewer than six strings.
  explicit GripWatch(const Profile& profile);

  /// Forgets everything. The grip is assumed to be at the centre, as when a device is opened.
  void reset() noexcept;

  /// Updates the pose with the reading of a tick in which the device has answered `command`.
  void update(const DeviceReading& reading, const GripCommand& command) noexcept;
  /// Call this when the device did not answer in a tick.
  void miss(int64_t now_ns) noexcept { trust_.miss(now_ns); }
  /// Ends trust if the newest pose is too old. Call this before computing the tensions of a tick.
  void check_age(int64_t now_ns) noexcept { trust_.check_age(now_ns); }

  bool trusted() const noexcept { return trust_.trusted(); }
  /// Whether a hand could have reached the newest pose, trusted or not, even outside the frame.
  bool follows() const noexcept { return follows_; }
  /// Returns kNone while the pose is trusted.
  PoseFault fault() const noexcept { return trust_.fault(); }
  /// The newest good pose, trusted or not.
  const Pose& pose() const noexcept { return pose_; }
  int64_t located_ns() const noexcept { return trust_.located_ns(); }
  double residual_m() const noexcept { return residual_m_; }
  int faulty_string() const noexcept { return faulty_string_; }
  /// The number of ticks in which the device answered, but the answer gave no pose.
  uint64_t pose_errors() const noexcept { return pose_errors_; }
  /// How often a string was newly found faulty.
  uint64_t string_faults() const noexcept { return string_faults_; }

 private:
  PoseFault judge(const PoseResult& result, bool jumps) const noexcept;
  bool is_frozen(const DeviceReading& reading, const GripCommand& command) noexcept;

  const Profile profile_;
  const EncoderScale encoders_;
  const double radius_m_;
  double reach_m_ = 0;  ///< bounds every coordinate of the grip's origin
  PoseSolver solver_;

  ReadingGate<kMaxStrings> gate_;
  PoseTrust trust_;
  Pose pose_;
  double residual_m_ = 0;
  int faulty_string_ = -1;
  uint64_t pose_errors_ = 0;
  uint64_t string_faults_ = 0;

  bool follows_ = false;
  bool frozen_ = false;
  bool counted_ = false;  ///< whether the two members below are known
  std::array<int32_t, kMaxStrings> last_count_{};
  Wrench at_last_change_;  ///< the command when a counter last moved
  double pushed_s_ = 0;    ///< how long the command has differed from it, weighted by size
};

/// A grip on strings. Converts a wrench to tensions and then to volts, and counts to lengths and
/// then to a pose. Keeps the strings taut, limits tensions, their rate of change and the heat of
/// the motors, leaves out a string that is slack or broken, and notices dead encoders.
class StringGrip final : public Grip {
 public:
  /// `device` outlives the grip. Throws std::invalid_argument for fewer than six strings.
  StringGrip(const Profile& profile, StringDevice& device);
  StringGrip(const Profile& profile, std::unique_ptr<StringDevice> device);

  void open() override;
  void advance(double passed_s) noexcept override;
  void check_age(int64_t now_ns) noexcept override;
  LinkFault exchange(const GripCommand& command) noexcept override;
  const GripReading& reading() const noexcept override { return reading_; }
  const GripTraits& traits() const noexcept override { return traits_; }
  GripAbilities abilities() const noexcept override { return abilities_; }

 private:
  void pull(const GripCommand& command) noexcept;
  void update(const DeviceReading& answer, const GripCommand& command) noexcept;
  void report() noexcept;

  const Profile profile_;
  std::unique_ptr<StringDevice> owned_;
  StringDevice& device_;
  const GripTraits traits_;
  const GripAbilities abilities_;
  const StringVector home_lengths_m_;  ///< string lengths with the grip in its home position
  GripReading reading_;
  GripWatch watch_;
  TensionChain chain_;
};

}  // namespace spidar
