// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Sound cards as devices, for the table of them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "spidar/boards/board.h"
#include "spidar/profiles/profile.h"
#include "spidar/session/board_list.h"

namespace spidar {

/// See DeviceKind::make and DeviceKind::list.
AnyBoard make_sound(const std::string& name, const std::string& rest, const Profile& profile);
std::vector<BoardInfo> list_sound();

/// ALSA's number of the card of "sound:CARD" and what follows it; nothing for another device, and
/// for what the ALSA configuration names.
std::optional<int> sound_card_number(const std::string& device);

}  // namespace spidar
