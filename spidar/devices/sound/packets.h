// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Forces as vibration of actuators at a sound card: bass shakers, and gamepads whose actuators
/// form a sound card (the DualSense: four channels, of which the last two are its voice coils;
/// hid-playstation of Linux and SDL leave these to the sound driver). The functions only convert
/// numbers, bytes and samples.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "core/default_limits.h"
#include "spidar/transports/bytes.h"

namespace spidar::sound {

constexpr size_t kMaxChannels = 4;
constexpr int kRate_Hz = 48'000;
/// The length of a block, which is written at once.
constexpr int kBlock_ms = 10;
constexpr int kBlockFrames = kRate_Hz / 1000 * kBlock_ms;
/// After this time, a level that is not renewed becomes silence, as with guardians (kSilence_ms).
constexpr int kSilence_ms = 50;
/// The force at full level, as for sticks: amplifiers do not report how strong they are.
constexpr double kFullForce_N = kDefaultForce_N;
/// Frequencies that bass shakers and voice coils play, and that the body feels as one vibration.
constexpr int kLowest_Hz = 20, kHighest_Hz = 120;

struct Settings {
  std::string card;
  /// A channel plays the component of the force along this unit vector; zero means silence.
  std::array<Eigen::Vector3d, kMaxChannels> direction{
      Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::Zero(),
      Eigen::Vector3d::Zero()};
  int channels = 2;  ///< up to the last channel that plays
  /// The geometric middle of the range; many bass shakers are strongest from 40 to 50 Hz.
  int carrier_Hz = 50;
  /// The fraction of full scale that is used, as for sticks (boards::StickEffects::kDefaultGain).
  double gain = 0.2;

  /// Parses "CARD", "CARD,3=x,4=0.6/0.8/0,carrier=40,gain=50". Channel 1 plays x and channel 2 y if
  /// the text names none. Throws DeviceError, whose text begins with `name`.
  static Settings parse(const std::string& name, const std::string& text);
};

/// The level of each channel, 0 … 1: a packet to the card.
struct Levels {
  std::array<float, kMaxChannels> level{};
};
/// Returns the levels for the magnitude of the force; nobody feels its sign. A force that is not a
/// number gives silence.
Levels levels_of(const Settings& settings, const Eigen::Vector3d& force_N) noexcept;

/// The answer to a packet.
struct State {
  int64_t lag_ns = 0;     ///< lag from a level to its sound, as the card reports it
  int32_t underruns = 0;  ///< how often the card ran out of sound since it was opened
  int32_t period_ms = 0;  ///< interval at which the card takes sound
};

template <typename Packet>
ByteView view_of(const Packet& packet) noexcept {
  return {reinterpret_cast<const uint8_t*>(&packet), sizeof packet};
}

/// Generates the samples: a sine of constant frequency in all channels, whose amplitude changes
/// linearly from one level to the next over one period. No change clicks, and for any levels the
/// samples add up to zero, so that a shaker is not pushed to one side.
class Carrier {
 public:
  explicit Carrier(int frequency_Hz) noexcept : step_(frequency_Hz / double{kRate_Hz}) {}

  /// Writes kBlockFrames frames as signed little-endian integers of `bytes` each. Channels of the
  /// card beyond kMaxChannels are silent. Returns how many frames after the beginning of this block
  /// the amplitude is half-way to `level`; nothing if no period begins in the block.
  std::optional<int> write(const Levels& level, int channels, int bytes, uint8_t* out) noexcept;
  bool rests() const noexcept {
    return from_.level == Levels().level && to_.level == Levels().level;
  }

 private:
  double step_, phase_ = 1;  ///< the next frame begins a period
  Levels from_, to_;
};

}  // namespace spidar::sound
