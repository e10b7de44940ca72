// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What ALSA can play on.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace spidar {

struct SoundCard {
  std::string id;  ///< of the card, "Controller", or of a device that the ALSA configuration names
  std::string name;  ///< for people
  std::string pcm;   ///< what ALSA calls it
};

/// What could be played on: cards, and devices of the ALSA configuration that are no way to other
/// ones. Opens no device.
std::vector<SoundCard> list_sound_cards();

/// ALSA's number of a card; nothing for what its configuration names.
std::optional<int> card_number(const std::string& id);

/// Whether a PCM of ALSA's configuration plays somewhere else: on what a server or a setting
/// chooses.
bool plays_elsewhere(const std::string& id);

}  // namespace spidar
