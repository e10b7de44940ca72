// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/session/sound_devices.h"

#include <memory>

#include "spidar/boards/sound_board.h"
#include "spidar/printable.h"
#include "spidar/transports/sound_cards.h"
#include "spidar/transports/sound_transport.h"

namespace spidar {

AnyBoard make_sound(const std::string& name, const std::string& rest, const Profile&) {
  const sound::Settings settings = sound::Settings::parse(name, rest);
  return std::unique_ptr<ForceBoard>(std::make_unique<SoundBoard>(
      name, std::make_unique<SoundTransport>(name, settings), settings));
}

std::vector<BoardInfo> list_sound() {
  std::vector<BoardInfo> boards;
  for (const SoundCard& card : list_sound_cards()) {
    BoardInfo& board = boards.emplace_back();
    board.device = "sound:" + card.id;
    board.name = printable(card.name);
    board.path = card.id;
    board.accessible = true;
    board.note = "for shakers that are connected to it; loudspeakers hum";
  }
  return boards;
}

std::optional<int> sound_card_number(const std::string& device) {
  const std::string begin = "sound:";
  if (device.compare(0, begin.size(), begin) != 0) return std::nullopt;
  return card_number(device.substr(begin.size(), device.find(',') - begin.size()));
}

}  // namespace spidar
