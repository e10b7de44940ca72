// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Sound cards that are coarse, large, without a clock, or fail.
#include <alsa/asoundlib.h>

#include "spidar/devices/sound/board.h"
#include "spidar/devices/sound/emulated.h"
#include "spidar/devices/sound/sound_transport.h"
#include "spidar/realtime/monotonic.h"
#include "tests/spidar/sound_fixture.h"
#include "tests/support/felt_player.h"
#include "tests/support/messages.h"

namespace spidar::test::sound_card_test {
namespace {

/// A card takes sound in periods of 10, 40 or 85 ms: it has what it takes next. Where the thread of
/// the sound gets no real-time priority, a busy machine interrupts some attempts.
TEST_F(Sound, PlaysWithoutGapsHoweverLongThePeriodsAre) {
  const std::pair<const char*, int> cards[] = {{"stereo", 0}, {"coarse", 40}, {"deep", 85}};
  for (const auto& [card, period_ms] : cards) {
    constexpr int kAttempts = 10;
    size_t gaps = 1;
    for (int i = 0; i < kAttempts && gaps > 0; ++i) {
      std::filesystem::remove(file_);
      const auto device = grip("sound:" + std::string(card) + ",1=x");
      device->open();
      push(*device, {1.5, 0, 0}, 800);
      EXPECT_GE(device->reading().lag_ns, period_ms / 2 * kMs) << card;
      device->close();
      gaps = count(Heard::kDry);
    }
    EXPECT_EQ(gaps, 0u) << card;
    const int longest_ms = std::max(period_ms, sound::kBlock_ms) + SoundTransport::kAhead_ms;
    for (const Heard& one : events())
      EXPECT_LE(one.waiting, static_cast<unsigned>(longest_ms * sound::kRate_Hz / 1000)) << card;
    EXPECT_GT(heard().size(), 700u * sound::kRate_Hz / 1000) << card;
  }
}

/// As that of some plug-ins.
TEST_F(Sound, ALargeBufferIsNotFilled) {
  const auto device = grip("sound:large,1=x");
  device->open();
  push(*device, {1.5, 0, 0}, 400);
  device->close();
  unsigned most = 0;
  for (const Heard& one : events()) most = std::max(most, one.waiting);
  EXPECT_GT(most, 0u);
  EXPECT_LE(most, static_cast<unsigned>(SoundTransport::kBuffer_ms * sound::kRate_Hz / 1000));
}

TEST_F(Sound, WhatHasNoClockGetsSoundAtThePaceOfACard) {
  const auto device = grip("sound:recorder,1=x");
  const int64_t begin_ns = monotonic_now_ns();
  device->open();
  push(*device, {1.5, 0, 0}, 500);
  device->close();
  const double took_s = 1e-9 * static_cast<double>(monotonic_now_ns() - begin_ns);
  const double recorded_s =
      static_cast<double>(std::filesystem::file_size(recorded_)) / (2 * 2 * sound::kRate_Hz);
  EXPECT_GT(recorded_s, 0);
  // 2 % faster than the clock, and what a card holds.
  EXPECT_LT(recorded_s, took_s * 50 / 49 + 1e-3 * (SoundTransport::kBuffer_ms + sound::kBlock_ms));
}

TEST_F(Sound, ACardThatFailsEachTimeIsLostAndDoesNotKeepAProcessorBusy) {
  const auto device = grip("sound:coarse,1=x");
  device->open();
  push(*device, {1, 0, 0}, 50);
  const int64_t begin_ns = monotonic_now_ns();
  const size_t before = count(Heard::kPrepared);
  std::ofstream(fails_) << "suspended";
  GripCommand command = told(1);
  wait_for([&] { return device->exchange(command) == LinkFault::kTimeout; });
  wait_for([&] { return device->exchange(command) == LinkFault::kGone; });
  const auto passed_ms = static_cast<size_t>((monotonic_now_ns() - begin_ns) / kMs);
  EXPECT_LE(count(Heard::kPrepared) - before, passed_ms / sound::kBlock_ms + 2);
  device->close();
  std::filesystem::remove(fails_);
  device->open();
  wait_for([&] { return device->exchange(command) == LinkFault::kNone; });
}

TEST(SoundBoard, SaysThatItRanDryMoreThanOnce) {
  auto emulated = std::make_unique<emulated::Sound>(std::make_shared<emulated::Motors>());
  sound::State& state = emulated->state;
  boards::Sound board("sound:a", std::make_unique<emulated::Transport>(std::move(emulated)));
  board.open();
  const auto warning_after = [&](int underruns) {
    state.underruns = underruns;
    state.period_ms = 85;
    boards::ForceReading reading;
    EXPECT_EQ(board.cycle({}, reading, monotonic_now_ns() + 100 * kMs), LinkFault::kNone);
    return board.warning();
  };
  EXPECT_EQ(warning_after(1), "");
  expect_contains(warning_after(3), "3 times");
  expect_contains(warning_after(12), "every 85 ms");
}

bool program_was_told = false;
void tell_program(const char*, int, const char*, int, const char*, ...) {
  program_was_told = true;
}

TEST_F(Sound, LeavesTheErrorHandlerOfTheProgram) {
  snd_lib_error_set_handler(tell_program);
  const auto device = grip("sound:stereo");
  device->open();
  device->close();
  EXPECT_NE(error("sound:none").first, "");
  program_was_told = false;
  snd_pcm_t* none = nullptr;
  EXPECT_LT(snd_pcm_open(&none, "no such device", SND_PCM_STREAM_PLAYBACK, 0), 0);
  EXPECT_TRUE(program_was_told);
  snd_lib_error_set_handler(nullptr);
}

}  // namespace
}  // namespace spidar::test::sound_card_test
