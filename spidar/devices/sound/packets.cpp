// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/sound/packets.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "core/number_text.h"
#include "spidar/device_error.h"

namespace spidar::sound {
namespace {

/// Parses "x", "-y" or "0.6/0.8/0"; returns zero for any other text and for a zero vector.
Eigen::Vector3d direction_of(const std::string& text) {
  const bool negative = text[0] == '-';
  const std::string letter = text.substr(negative);
  if (letter.size() == 1 && letter[0] >= 'x' && letter[0] <= 'z') {
    return (negative ? -1 : 1) * Eigen::Vector3d::Unit(letter[0] - 'x');
  }
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  std::string_view left = text;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const size_t end = axis < 2 ? left.find('/') : left.size();
    const std::optional<double> component = number_of(left.substr(0, end));
    if (!component || end > left.size()) return Eigen::Vector3d::Zero();
    vector[axis] = *component;
    left.remove_prefix(std::min(end + 1, left.size()));
  }
  return vector.stableNormalized();
}

/// Parses a whole number from `least` to `most`; returns −1 for any other text.
int number_in(const std::string& text, int least, int most) {
  if (text.empty() || text.size() > 3 ||
      text.find_first_not_of("0123456789") != std::string::npos) {
    return -1;
  }
  const int value = std::atoi(text.c_str());
  return value >= least && value <= most ? value : -1;
}

/// Returns false for a text that is not an option, and for an option that was given before.
bool parse_option(const std::string& option, Settings& settings, bool& has_carrier,
                  bool& has_gain) {
  const size_t equals = option.find('=');
  if (equals == std::string::npos || equals + 1 == option.size()) return false;
  const std::string key = option.substr(0, equals), value = option.substr(equals + 1);
  if (key == "carrier" && !std::exchange(has_carrier, true)) {
    return (settings.carrier_Hz = number_in(value, kLowest_Hz, kHighest_Hz)) > 0;
  }
  if (key == "gain" && !std::exchange(has_gain, true)) {
    return (settings.gain = number_in(value, 1, 100) / 100.0) > 0;
  }
  const int channel = number_in(key, 1, kMaxChannels);
  if (channel < 0) return false;
  Eigen::Vector3d& direction = settings.direction[static_cast<size_t>(channel - 1)];
  if (!direction.isZero(0)) return false;
  direction = direction_of(value);
  settings.channels = std::max(settings.channels, channel);
  return !direction.isZero(0);
}

}  // namespace

Settings Settings::parse(const std::string& name, const std::string& text) {
  Settings settings;
  settings.direction.fill(Eigen::Vector3d::Zero());
  settings.channels = 0;
  size_t comma = text.find(',');
  settings.card = text.substr(0, comma);
  if (settings.card.empty()) {
    throw DeviceError(name + ": the name of the card is empty; spidarctl list names sound cards",
                      DeviceErrorCode::kSettings);
  }
  bool has_carrier = false, has_gain = false;
  while (comma != std::string::npos) {
    const size_t end = text.find(',', comma + 1);
    const std::string option =
        text.substr(comma + 1, end == std::string::npos ? end : end - comma - 1);
    if (!parse_option(option, settings, has_carrier, has_gain)) {
      const std::string card = "sound:" + settings.card;
      throw DeviceError(
          name + ": \"" + option + "\" is unknown, out of range or given twice; write " + card +
              ",3=x,4=-y for the direction that channel 3 and 4 play (x, y, z, or 0.6/0.8/0), " +
              card + ",carrier=40 for 40 Hz (20 to 120), or " + card +
              ",gain=50 for 50 % of the full volume (1 to 100)",
          DeviceErrorCode::kSettings);
    }
    comma = end;
  }
  if (settings.channels > 0) return settings;
  const Settings unnamed;
  settings.direction = unnamed.direction;
  settings.channels = unnamed.channels;
  return settings;
}

Levels levels_of(const Settings& settings, const Eigen::Vector3d& force_N) noexcept {
  Levels levels;
  if (!force_N.allFinite()) return levels;
  for (size_t i = 0; i < kMaxChannels; ++i) {
    const double fraction = std::fabs(settings.direction[i].dot(force_N)) / kFullForce_N;
    levels.level[i] = static_cast<float>(settings.gain * std::min(fraction, 1.0));
  }
  return levels;
}

std::optional<int> Carrier::write(const Levels& level, int channels, int bytes,
                                  uint8_t* out) noexcept {
  constexpr double kFull = 2147483647;
  std::optional<int> half_way;
  for (int frame = 0; frame < kBlockFrames; ++frame) {
    if (phase_ >= 1) {
      phase_ -= 1;
      from_ = std::exchange(to_, level);
      half_way = frame + static_cast<int>(0.5 / step_);
    }
    const double wave = std::sin(2 * M_PI * phase_);
    for (int channel = 0; channel < channels; ++channel) {
      const auto i = static_cast<size_t>(channel);
      const double now =
          i < kMaxChannels ? from_.level[i] + phase_ * (to_.level[i] - from_.level[i]) : 0;
      const auto sample =
          static_cast<uint32_t>(static_cast<int32_t>(kFull * std::clamp(now, 0.0, 1.0) * wave));
      for (int byte = 4 - bytes; byte < 4; ++byte) {
        *out++ = static_cast<uint8_t>(sample >> 8 * byte);
      }
    }
    phase_ += step_;
  }
  return half_way;
}

}  // namespace spidar::sound
