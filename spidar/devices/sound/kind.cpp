// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <memory>

#include "spidar/devices/sound/board.h"
#include "spidar/devices/sound/emulated.h"
#include "spidar/devices/sound/sound_cards.h"
#include "spidar/devices/sound/sound_transport.h"
#include "spidar/link/device_kind.h"
#include "spidar/text.h"

namespace spidar {
namespace {

boards::AnyBoard make_sound(const std::string& name, const std::string& rest, const Profile&) {
  const sound::Settings settings = sound::Settings::parse(name, rest);
  return std::make_unique<boards::Sound>(name, std::make_unique<SoundTransport>(name, settings),
                                         settings);
}

std::vector<DeviceInfo> list_sound() {
  std::vector<DeviceInfo> boards;
  for (const SoundCard& card : list_sound_cards()) {
    DeviceInfo& board = boards.emplace_back();
    board.device = "sound:" + card.id;
    board.name = printable(card.name);
    board.path = card.id;
    board.accessible = true;
    board.note = "for shakers that are connected to it; loudspeakers hum";
  }
  return boards;
}

}  // namespace

std::vector<DeviceKind> sound_kinds() {
  return {{.device = "sound",
           .board = "sound",
           .title = "sound card",
           .names = "sound:CARD, sound:CARD,CHANNEL=DIRECTION",
           .attach = attach<boards::Sound>,
           .emulate = emulate<emulated::Sound>,
           .make = make_sound,
           .list = list_sound}};
}

}  // namespace spidar
