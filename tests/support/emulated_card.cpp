// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// A sound card as a plugin of ALSA's library, which records what it plays and when. In ALSA's
// configuration:
//   pcm_type.emulated { lib PATH }
//   pcm.shaker { type emulated channels 4 latency_ms 40 file PATH gone PATH }
// Its clock is CLOCK_MONOTONIC. Sound is heard `latency_ms` after it leaves the buffer, which
// snd_pcm_delay() includes. `file` receives a Heard for each write, and its samples. The card is
// unplugged while the file `gone` exists, and seems suspended while `fails` exists. With
// `period_ms`, the card takes sound in such steps and no shorter ones; `buffer_ms` is the size of
// its buffer.
#include "tests/support/emulated_card.h"

#include <alsa/asoundlib.h>
#include <alsa/pcm_external.h>
#include <cstdint>
#include <cstdio>
#include <string>
#include <sys/timerfd.h>
#include <unistd.h>

namespace {

using spidar::test::Heard;

constexpr int64_t kSecond_ns = 1'000'000'000;

struct Card {
  snd_pcm_ioplug_t io{};
  long channels = 2, latency_ms = 0, period_ms = 0, buffer_ms = 0;
  std::string file, gone, fails;
  FILE* out = nullptr;
  int64_t start_ns = 0;  // when the first frame left the buffer; 0: the card does not run
  int64_t written = 0;   // frames since prepare()

  bool is_gone() const { return access(gone.c_str(), F_OK) == 0; }
  bool is_failing() const { return !fails.empty() && access(fails.c_str(), F_OK) == 0; }
  int64_t played() const {
    if (start_ns == 0) return 0;
    const int64_t frames = (spidar::test::now_ns() - start_ns) * io.rate / kSecond_ns;
    const int64_t step = period_ms > 0 ? period_ms * io.rate / 1000 : 1;
    return frames / step * step;
  }
  void note(Heard::Kind kind) const {
    const Heard heard{kind, spidar::test::now_ns(), 0, 0, 0};
    std::fwrite(&heard, sizeof heard, 1, out);
    std::fflush(out);
  }
};

Card& card_of(snd_pcm_ioplug_t* io) {
  return *static_cast<Card*>(io->private_data);
}

int start(snd_pcm_ioplug_t* io) {
  Card& card = card_of(io);
  if (card.is_gone()) return -ENODEV;
  card.start_ns = spidar::test::now_ns();
  const long each_ns = card.period_ms > 0 ? card.period_ms * 1'000'000 : 1'000'000;
  const itimerspec each_ms{{0, each_ns}, {0, each_ns}};
  return timerfd_settime(io->poll_fd, 0, &each_ms, nullptr);
}

int stop(snd_pcm_ioplug_t* io) {
  Card& card = card_of(io);
  card.note(Heard::kStopped);
  card.start_ns = 0;
  return 0;
}

snd_pcm_sframes_t pointer(snd_pcm_ioplug_t* io) {
  const Card& card = card_of(io);
  if (card.is_gone()) return -ENODEV;
  const int64_t played = card.played();
  if (played > card.written) {
    card.note(Heard::kDry);
    return -EPIPE;
  }
  return static_cast<snd_pcm_sframes_t>(played % static_cast<int64_t>(io->buffer_size));
}

/// Frames before a start are heard when the card starts, which is unknown yet: they are recorded
/// with the time 0.
snd_pcm_sframes_t transfer(snd_pcm_ioplug_t* io, const snd_pcm_channel_area_t* areas,
                           snd_pcm_uframes_t offset, snd_pcm_uframes_t size) {
  Card& card = card_of(io);
  if (card.is_gone()) return -ENODEV;
  if (card.is_failing()) return -ESTRPIPE;
  const int64_t at_ns = card.start_ns == 0 ? 0
                                           : card.start_ns + card.written * kSecond_ns / io->rate +
                                                 card.latency_ms * 1'000'000;
  const Heard heard{
      Heard::kPlayed, at_ns, static_cast<uint32_t>(size), static_cast<uint32_t>(io->channels),
      static_cast<uint32_t>(card.written + static_cast<int64_t>(size) - card.played())};
  const char* const samples =
      static_cast<const char*>(areas->addr) + (areas->first + areas->step * offset) / 8;
  std::fwrite(&heard, sizeof heard, 1, card.out);
  std::fwrite(samples, 2 * io->channels, size, card.out);
  std::fflush(card.out);
  card.written += static_cast<int64_t>(size);
  return static_cast<snd_pcm_sframes_t>(size);
}

int prepare(snd_pcm_ioplug_t* io) {
  Card& card = card_of(io);
  card.start_ns = card.written = 0;
  card.note(Heard::kPrepared);
  return card.is_gone() ? -ENODEV : 0;
}

int delay(snd_pcm_ioplug_t* io, snd_pcm_sframes_t* frames) {
  const Card& card = card_of(io);
  if (card.is_gone()) return -ENODEV;
  *frames = static_cast<snd_pcm_sframes_t>(card.written - card.played() +
                                           card.latency_ms * io->rate / 1000);
  return 0;
}

int poll_revents(snd_pcm_ioplug_t* io, pollfd* fds, unsigned, unsigned short* events) {
  uint64_t ticks = 0;
  *events = fds->revents != 0 && read(io->poll_fd, &ticks, sizeof ticks) > 0 ? POLLOUT : 0;
  if (card_of(io).is_gone()) *events = POLLERR | POLLNVAL;
  return 0;
}

int close_card(snd_pcm_ioplug_t* io) {
  Card* const card = &card_of(io);
  if (card->out) std::fclose(card->out);
  close(io->poll_fd);
  delete card;
  return 0;
}

}  // namespace

extern "C" {

SND_PCM_PLUGIN_DEFINE_FUNC(emulated) {
  (void)root;
  Card* const card = new Card;
  snd_config_iterator_t at, next;
  snd_config_for_each(at, next, conf) {
    snd_config_t* const entry = snd_config_iterator_entry(at);
    const char* id = nullptr;
    if (snd_config_get_id(entry, &id) < 0) continue;
    if (std::string(id) == "channels") snd_config_get_integer(entry, &card->channels);
    if (std::string(id) == "latency_ms") snd_config_get_integer(entry, &card->latency_ms);
    if (std::string(id) == "period_ms") snd_config_get_integer(entry, &card->period_ms);
    if (std::string(id) == "buffer_ms") snd_config_get_integer(entry, &card->buffer_ms);
    const char* text = "";
    if (std::string(id) == "file" && snd_config_get_string(entry, &text) == 0) card->file = text;
    if (std::string(id) == "fails" && snd_config_get_string(entry, &text) == 0) card->fails = text;
    if (std::string(id) == "gone" && snd_config_get_string(entry, &text) == 0) card->gone = text;
  }
  if (card->is_gone()) {
    delete card;
    return -ENODEV;
  }
  static const snd_pcm_ioplug_callback_t kCallbacks = [] {
    snd_pcm_ioplug_callback_t calls{};
    calls.start = start;
    calls.stop = stop;
    calls.pointer = pointer;
    calls.transfer = transfer;
    calls.close = close_card;
    calls.prepare = prepare;
    calls.delay = delay;
    calls.poll_revents = poll_revents;
    return calls;
  }();
  card->out = std::fopen(card->file.c_str(), "ab");
  card->io.version = SND_PCM_IOPLUG_VERSION;
  card->io.name = "emulated card";
  card->io.callback = &kCallbacks;
  card->io.private_data = card;
  card->io.poll_fd = timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC);
  card->io.poll_events = POLLIN;
  int error = snd_pcm_ioplug_create(&card->io, name, stream, mode);
  const unsigned access = SND_PCM_ACCESS_RW_INTERLEAVED, format = SND_PCM_FORMAT_S16_LE;
  const auto channels = static_cast<unsigned>(card->channels);
  if (error >= 0)
    error = snd_pcm_ioplug_set_param_list(&card->io, SND_PCM_IOPLUG_HW_ACCESS, 1, &access);
  if (error >= 0)
    error = snd_pcm_ioplug_set_param_list(&card->io, SND_PCM_IOPLUG_HW_FORMAT, 1, &format);
  if (error >= 0)
    error =
        snd_pcm_ioplug_set_param_minmax(&card->io, SND_PCM_IOPLUG_HW_CHANNELS, channels, channels);
  if (error >= 0)
    error = snd_pcm_ioplug_set_param_minmax(&card->io, SND_PCM_IOPLUG_HW_RATE, 48000, 48000);
  const auto bytes_of = [&](long ms) { return static_cast<unsigned>(ms) * 48 * 2 * channels; };
  const auto set = [&](int type, unsigned least, unsigned most) {
    if (error >= 0) error = snd_pcm_ioplug_set_param_minmax(&card->io, type, least, most);
  };
  if (card->period_ms > 0) {
    set(SND_PCM_IOPLUG_HW_PERIOD_BYTES, bytes_of(card->period_ms), bytes_of(card->period_ms));
    set(SND_PCM_IOPLUG_HW_PERIODS, 2, 16);
  }
  if (card->buffer_ms > 0)
    set(SND_PCM_IOPLUG_HW_BUFFER_BYTES, bytes_of(card->buffer_ms), bytes_of(card->buffer_ms));
  if (error >= 0) *pcmp = card->io.pcm;
  return error;
}

SND_PCM_PLUGIN_SYMBOL(emulated);
}
