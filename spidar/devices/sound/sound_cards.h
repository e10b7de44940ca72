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
  std::string pcm;          ///< what ALSA calls it
  std::string place = pcm;  ///< ALSA's long name; with the port of a card on USB

  DeviceIdentity identity() const { return {name, "", place}; }
};

/// Lists sound cards and the PCMs of the ALSA configuration, without those that only lead to
/// another one. Opens no PCM.
std::vector<SoundCard> list_sound_cards();

/// ALSA's number of a card; nothing for a device that its configuration names.
std::optional<int> card_number(const std::string& id);

/// The card with this id or, if `first` knows a card, that same card, whatever its id is by
/// now: the kernel gives the id of a card that is gone to the next one of its name. Throws
/// DeviceError for `device` if the card is not there, or if another one has its id now.
SoundCard resolve_card(const std::string& device, const std::string& id, const FirstDevice& first,
                       const std::vector<SoundCard>& cards);

/// "there are sound:Controller, sound:shaker"
std::string names_of(const std::vector<SoundCard>& cards);

/// Whether a PCM of ALSA's configuration plays nowhere, or elsewhere: on whatever a server or a
/// setting chooses, or converted on another PCM.
bool plays_elsewhere(const std::string& id);

}  // namespace spidar
