// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A grip that hangs on strings.
#pragma once

#include <memory>

#include "spidar/device.h"
#include "spidar/grip/grip.h"
#include "spidar/grip/grip_watch.h"
#include "spidar/grip/motor_heat.h"
#include "spidar/grip/tension_command.h"
#include "spidar/grip/tension_limits.h"
#include "spidar/profiles/profile.h"

namespace spidar {

/// A wrench becomes tensions, tensions become volts; counts become lengths, lengths a pose. It
/// keeps the strings taut, limits their tensions, the rate of these and the heat of the motors,
/// leaves out a string that is slack or broken, and notices encoders that are dead.
class StringGrip final : public Grip {
 public:
  /// `device` outlives the grip. Throws std::invalid_argument when the profile has fewer than six
  /// strings.
  StringGrip(const Profile& profile, Device& device);
  StringGrip(const Profile& profile, std::unique_ptr<Device> device);

  void open() override;
  void pass(double passed_s) noexcept override;
  void check_age(int64_t now_ns) noexcept override;
  ExchangeStatus exchange(const GripCommand& command) noexcept override;
  const GripReading& reading() const noexcept override { return reading_; }
  void close() noexcept override { device_.close(); }
  const GripTraits& traits() const noexcept override { return traits_; }
  std::string description() const override { return device_.description(); }
  GripAbilities abilities() const noexcept override { return abilities_; }
  LinkHealth health() const noexcept override { return device_.health(); }
  const std::string& name() const noexcept override { return device_.name(); }

 private:
  void pull(const GripCommand& command) noexcept;
  void see(const DeviceReading& answer, const GripCommand& command) noexcept;
  void report() noexcept;

  const Profile profile_;
  const std::unique_ptr<Device> owned_;
  Device& device_;
  const GripTraits traits_;
  const GripAbilities abilities_;
  GripReading reading_;
  GripWatch watch_;
  TensionCommand tension_command_;
  TensionSlew tension_slew_;
  MotorHeat heat_;
  StringVector acknowledged_N_ = StringVector::Zero();  ///< of the last command that was answered
};

}  // namespace spidar
