// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The sound cards and devices on which ALSA can play.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "spidar/transports/device_identity.h"

namespace spidar {

struct SoundCard {
  std::string id;  ///< of the card, "Controller", or of a device that the ALSA configuration names
  std::string name;         ///< for people
  std::string pcm;          ///< ALSA's name of the device
  std::string place = pcm;  ///< ALSA's long name; with the port of a card on USB

  DeviceIdentity identity() const { return {name, "", place}; }
};

/// Lists sound cards and the PCMs of the ALSA configuration, without those that only lead to
/// another one. Opens no PCM.
std::vector<SoundCard> list_sound_cards();

/// Returns ALSA's number of a card; nothing for a device that the configuration names.
std::optional<int> card_number(const std::string& id);

/// Returns the card with this id or, if `first` knows a card, that same card under any id: the
/// kernel gives the id of a card that is gone to the next card of that name. Throws DeviceError for
/// `device` if the card is not there, or if another card has its id now.
SoundCard resolve_card(const std::string& device, const std::string& id, const FirstDevice& first,
                       const std::vector<SoundCard>& cards);

/// Returns "there are sound:Controller, sound:shaker".
std::string names_of(const std::vector<SoundCard>& cards);

/// Returns whether a PCM of ALSA's configuration plays nowhere or on another device: one that a
/// server or a setting chooses, or another PCM after a conversion.
bool plays_elsewhere(const std::string& id);

}  // namespace spidar
