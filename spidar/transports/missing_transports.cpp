// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// In a build without ALSA, without libwebsockets, or without both.
#include "spidar/device.h"
#include "spidar/transports/sound_cards.h"
#include "spidar/transports/sound_transport.h"
#include "spidar/transports/websocket_transport.h"

namespace spidar {

#ifndef SPIDAR_HAS_ALSA

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

Transfer SoundTransport::exchange(std::initializer_list<ByteView>, MutableBytes, int64_t) noexcept {
  return {LinkFault::kGone, 0};
}

void SoundTransport::close() noexcept {}

#endif
#ifndef SPIDAR_HAS_LIBWEBSOCKETS

class WebSocketTransport::Connection {};

WebSocketTransport::WebSocketTransport(std::string name, uint16_t port, std::string cure)
    : name_(std::move(name)), port_(port), cure_(std::move(cure)) {}

WebSocketTransport::~WebSocketTransport() = default;

void WebSocketTransport::open() {
  throw DeviceError(
      name_ +
          ": this build of gst-spidar cannot reach services: install libwebsockets-dev "
          "and build it with -Dwebsockets=enabled",
      DeviceErrorCode::kSettings);
}

Transfer WebSocketTransport::exchange(std::initializer_list<ByteView>, MutableBytes,
                                      int64_t) noexcept {
  return {LinkFault::kGone, 0};
}

void WebSocketTransport::recover() noexcept {}

std::optional<LastWill> WebSocketTransport::last_will() const {
  return std::nullopt;
}

void WebSocketTransport::close() noexcept {}

#endif

}  // namespace spidar
