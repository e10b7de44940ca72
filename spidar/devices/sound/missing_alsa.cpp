// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The sound cards of a build without ALSA: none is listed, and none can be opened.
#include "spidar/device.h"
#include "spidar/devices/sound/sound_cards.h"
#include "spidar/devices/sound/sound_transport.h"

namespace spidar {

class SoundTransport::Pcm {};

std::vector<SoundCard> list_sound_cards() {
  return {};
}

std::optional<int> card_number(const std::string&) {
  return std::nullopt;
}

SoundTransport::SoundTransport(std::string name, sound::Settings settings)
    : name_(std::move(name)), settings_(std::move(settings)) {}

SoundTransport::~SoundTransport() = default;

void SoundTransport::open() {
  throw DeviceError(
      name_ +
          ": this build of gst-spidar cannot play sound: install libasound2-dev and build it with "
          "-Dsound=enabled",
      DeviceErrorCode::kSettings);
}

Transfer SoundTransport::transfer(std::initializer_list<ByteView>, MutableBytes, int64_t) noexcept {
  return {LinkFault::kGone, 0};
}

void SoundTransport::close() noexcept {}

}  // namespace spidar
