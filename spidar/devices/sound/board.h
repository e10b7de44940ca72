// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Vibrating actuators behind a sound card: up to four directions of force, no position.
#pragma once

#include <algorithm>
#include <atomic>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "spidar/devices/sound/packets.h"
#include "spidar/link/board.h"
#include "spidar/link/board_parts.h"
#include "spidar/text.h"
#include "spidar/transports/transport.h"

namespace spidar::boards {

/// The card needs no guardian because it stops by itself: the kernel stops the card when this
/// process ends, and when this process is stopped, the card falls silent after its buffer
/// (SoundTransport).
class Sound final : public OnTransport<ForceBoard> {
 public:
  Sound(std::string name, std::unique_ptr<Transport> transport, sound::Settings settings = {})
      : OnTransport(std::move(name), std::move(transport)), settings_(std::move(settings)) {
    abilities_.torque = false;
    abilities_.position = {};
    abilities_.largest_force_N = sound::kFullForce_N;
    abilities_.rate_Hz = std::min(1000 / sound::kBlock_ms, settings_.carrier_Hz);
    for (size_t axis = 0; axis < 3; ++axis) {
      abilities_.force[axis] = false;
      for (const Eigen::Vector3d& direction : settings_.direction) {
        if (direction[static_cast<Eigen::Index>(axis)] != 0) abilities_.force[axis] = true;
      }
    }
  }

  void open() override {
    transport_->open();
    const LinkFault fault =
        open_exchange([&](int64_t deadline_ns) { return play({}, deadline_ns); }, *transport_);
    if (fault != LinkFault::kNone) throw no_answer(name_, fault);
  }
  LinkFault cycle(const ForceOutput& output, ForceReading& reading,
                  int64_t deadline_ns) noexcept override {
    const LinkFault fault = play(sound::levels_of(settings_, output.force_N), deadline_ns);
    if (fault != LinkFault::kNone) return fault;
    reading.position_m.setZero();
    reading.lag_ns = lag_ns_;
    return LinkFault::kNone;
  }
  void close() noexcept override {
    play({}, soon_ns());
    OnTransport::close();
  }
  std::vector<LastWill> last_wills() const override { return {}; }
  std::string description() const override {
    const std::string text = formatted(
        "%d channel%s of a sound card, %d Hz at %.0f %% of full volume", settings_.channels,
        settings_.channels > 1 ? "s" : "", settings_.carrier_Hz, 100 * settings_.gain);
    const int64_t lag_ns = lag_ns_;
    if (lag_ns <= 0) return text;  // the lag is known once the card plays
    return text + formatted(", heard after %.0f ms", 1e-6 * static_cast<double>(lag_ns));
  }
  std::string warning() const override {
    constexpr int kOften = 3;  // once or twice is a busy moment
    const int underruns = underruns_;
    if (underruns < kOften) return {};
    return name_ + " had nothing to play " + std::to_string(underruns) +
           " times: its sound is interrupted. It takes sound every " + std::to_string(period_ms_) +
           " ms; real-time priority for this program helps, or another card.";
  }
  GripAbilities abilities() const noexcept override { return abilities_; }

 private:
  LinkFault play(const sound::Levels& levels, int64_t deadline_ns) noexcept {
    sound::State state;
    const Transfer transfer = transport_->exchange(
        {sound::view_of(levels)}, {reinterpret_cast<uint8_t*>(&state), sizeof state}, deadline_ns);
    if (transfer.fault == LinkFault::kNone) {
      lag_ns_ = state.lag_ns;
      underruns_ = state.underruns;
      period_ms_ = state.period_ms;
    }
    return transfer.fault;
  }

  const sound::Settings settings_;
  GripAbilities abilities_;
  std::atomic<int64_t> lag_ns_{0};
  std::atomic<int> underruns_{0}, period_ms_{0};
};

}  // namespace spidar::boards
