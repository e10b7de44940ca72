// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "spidar/devices/sound/packets.h"
#include "spidar/realtime/seqlock.h"
#include "spidar/transports/device_identity.h"
#include "spidar/transports/transport.h"

namespace spidar {

/// Plays levels on a sound card of ALSA. A packet is sound::Levels, its answer sound::State.
/// Exchanges do not wait, because a thread writes the sound. The thread plays silence when no
/// packet has come for sound::kSilence_ms. The card holds at most its period, which it takes at
/// once, and kAhead_ms. The card stops when it has played them, also when this process is stopped
/// or killed.
///
/// Only the card itself is opened, never a server that may choose other speakers.
class SoundTransport final : public Transport {
 public:
  /// The thread wakes for each block, and may be late by another one.
  static constexpr int kAhead_ms = 2 * sound::kBlock_ms;
  /// The buffer of a card that accepts short periods.
  static constexpr int kBuffer_ms = kAhead_ms + sound::kBlock_ms;
  /// A card has a fault if it takes no sound for this time beyond the playing time of its buffer.
  static constexpr int kTimeout_ms = 100;
  /// A card that takes nothing for this time is opened again.
  static constexpr int kHopeless_ms = 1000;

  SoundTransport(std::string name, sound::Settings settings);
  ~SoundTransport() override;

  void open() override;
  void recover() noexcept override {}
  std::optional<LastWill> last_will() const override { return std::nullopt; }
  void close() noexcept override;

 private:
  Transfer transfer(std::initializer_list<ByteView> packets, MutableBytes reply,
                    int64_t deadline_ns) noexcept override;
  class Pcm;
  struct Fed {
    sound::Levels levels;
    int64_t at_ns = 0;
  };

  void play() noexcept;
  void set_lag(int64_t lag_ns) noexcept;

  const std::string name_;
  const sound::Settings settings_;
  FirstDevice first_;
  std::unique_ptr<Pcm> pcm_;
  std::thread thread_;
  std::atomic<bool> stop_{false};
  std::atomic<LinkFault> fault_{LinkFault::kGone};
  std::atomic<int64_t> lag_ns_{0};
  std::atomic<int> underruns_{0};
  Seqlock<Fed> fed_;
};

}  // namespace spidar
