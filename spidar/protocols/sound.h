// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Forces as vibration of what is connected to a sound card: bass shakers, and pads whose actuators
/// are a sound card (the DualSense: four channels, of which the last two are its voice coils;
/// hid-playstation of Linux and SDL leave these to the sound driver).
///
/// Pure: numbers in, bytes and samples out.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include <Eigen/Core>

#include "spidar/protocols/bytes.h"

namespace spidar::sound {

constexpr size_t kMostChannels = 4;
constexpr int kRate_Hz = 48'000;
/// A sine is interpolated between two levels in this time, so that no change clicks.
constexpr int kRamp_ms = 10;
constexpr int kRampFrames = kRate_Hz / 1000 * kRamp_ms;
/// A level that is not renewed for this time is followed by silence, as with guardians
/// (kSilence_ms).
constexpr int kSilence_ms = 50;
/// The force for full level, as for sticks: amplifiers do not report how strong they are.
constexpr double kFullForce_N = 3.0;
/// What bass shakers and voice coils can do, and a hand or a back feels as one vibration.
constexpr int kLowest_Hz = 20, kHighest_Hz = 120;

/// What follows "sound:".
struct Settings {
  std::string card;
  /// The force that a channel plays is the one along this unit vector; zero: silence.
  std::array<Eigen::Vector3d, kMostChannels> direction{
      Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::Zero(),
      Eigen::Vector3d::Zero()};
  int channels = 2;  ///< up to the last one that plays
  /// The geometric middle of the range; many bass shakers are strongest from 40 to 50 Hz.
  int carrier_Hz = 50;
  /// The fraction of full scale that is used, as with sticks (StickEffects::kDefaultGain).
  double gain = 0.2;

  /// "CARD", "CARD,3=x,4=0.6/0.8/0,carrier=40,gain=50". Channel 1 plays x and channel 2 y if none
  /// is named. Throws DeviceError, whose text begins with `name`.
  static Settings parse(const std::string& name, const std::string& text);
};

/// Level of each channel, −1 … 1: a packet to the card. The sign is the phase, which is not felt;
/// the strength is.
struct Levels {
  std::array<float, kMostChannels> level{};
};
/// No level for a force that is not a number.
Levels levels_of(const Settings& settings, const Eigen::Vector3d& force_N) noexcept;

/// The answer to a packet.
struct State {
  int64_t lag_ns = 0;  ///< from a level to its sound, as the card reports it
};

template <typename Packet>
ByteView view_of(const Packet& packet) noexcept {
  return {reinterpret_cast<const uint8_t*>(&packet), sizeof packet};
}

/// The samples: a sine of constant frequency in all channels.
class Carrier {
 public:
  Carrier() = default;
  explicit Carrier(int frequency_Hz) noexcept : step_(frequency_Hz / double{kRate_Hz}) {}

  /// Writes kRampFrames frames, in which the level goes from the last one to this one, as signed
  /// little-endian integers of `bytes` each. Channels of the card beyond kMostChannels are silent.
  void write(const Levels& to, int channels, int bytes, uint8_t* out) noexcept;
  bool rests() const noexcept { return from_.level == Levels().level; }

 private:
  double step_ = 0, phase_ = 0;
  Levels from_;
};

}  // namespace spidar::sound
