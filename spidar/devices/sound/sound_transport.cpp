// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/sound/sound_transport.h"

#include <algorithm>
#include <alsa/asoundlib.h>
#include <optional>
#include <utility>
#include <vector>

#include "spidar/device.h"
#include "spidar/devices/sound/quiet_alsa.h"
#include "spidar/devices/sound/sound_cards.h"
#include "spidar/realtime/monotonic.h"
#include "spidar/realtime/thread_setup.h"

namespace spidar {
namespace {

constexpr int64_t kMillisecond_ns = kSecond_ns / 1000;
constexpr snd_pcm_uframes_t kAhead =
    static_cast<snd_pcm_uframes_t>(sound::kRate_Hz / 1000 * SoundTransport::kAhead_ms);
constexpr int64_t kBlock_ns = sound::kBlock_ms * kMillisecond_ns;

constexpr int64_t ns_of(snd_pcm_sframes_t frames) {
  return frames * kSecond_ns / sound::kRate_Hz;
}

}  // namespace

class SoundTransport::Pcm {
 public:
  /// Throws DeviceError, whose text begins with `name`.
  Pcm(const std::string& name, const SoundCard& card, int least_channels);
  ~Pcm() { snd_pcm_close(handle_); }
  Pcm(const Pcm&) = delete;
  Pcm& operator=(const Pcm&) = delete;

  /// Waits until there may be room for a block. Returns how many frames play before the block;
  /// nothing when there is no room; ALSA's error, below 0.
  std::optional<snd_pcm_sframes_t> wait_for_space() noexcept;
  /// Returns ALSA's error, or 0.
  int write(const uint8_t* block) noexcept;
  /// Continues after an error. Returns false if that is not possible.
  bool recover(int error) noexcept;
  /// Plays the rest of the buffer.
  void drain() noexcept;

  int channels() const noexcept { return static_cast<int>(channels_); }
  int bytes() const noexcept { return bytes_; }
  size_t block_bytes() const noexcept {
    return channels_ * static_cast<size_t>(bytes_) * sound::kBlockFrames;
  }
  int period_ms() const noexcept {
    return static_cast<int>(ns_of(static_cast<snd_pcm_sframes_t>(period_)) / kMillisecond_ns);
  }
  /// How long the used part of the buffer plays.
  int64_t held_ns() const noexcept { return ns_of(held_); }
  bool is_running() const noexcept { return snd_pcm_state(handle_) == SND_PCM_STATE_RUNNING; }

 private:
  int set_hardware(unsigned least_channels);
  int set_software();

  snd_pcm_t* handle_ = nullptr;
  unsigned channels_ = 0;
  int bytes_ = 0;  ///< per sample
  snd_pcm_uframes_t buffer_ = 0, period_ = 0;
  snd_pcm_sframes_t held_ = 0;  ///< frames in the buffer that are used
  int64_t next_ns_ = 0;         ///< when the next block is due
  std::string error_;
};

SoundTransport::Pcm::Pcm(const std::string& name, const SoundCard& card, int least_channels) {
  const int error =
      snd_pcm_open(&handle_, card.pcm.c_str(), SND_PCM_STREAM_PLAYBACK, SND_PCM_NONBLOCK);
  if (error < 0) {
    throw DeviceError(
        name + ": cannot be opened: " + snd_strerror(error) +
            (error == -EBUSY
                 ? "; another program plays on it, perhaps the sound server: choose another "
                   "card there, or wait until it is silent"
                 : ""),
        error_code_of(-error));
  }
  int wrong = set_hardware(static_cast<unsigned>(least_channels));
  if (wrong >= 0) wrong = set_software();
  if (wrong >= 0) return;
  snd_pcm_close(handle_);
  throw DeviceError(name + ": cannot be used: " + error_ + " (" + snd_strerror(wrong) + ")",
                    DeviceErrorCode::kSettings);
}

/// Opens at least as many channels as the device itself has, because a conversion would play them
/// on other outputs.
int SoundTransport::Pcm::set_hardware(unsigned least_channels) {
  constexpr std::pair<snd_pcm_format_t, int> kFormats[] = {
      {SND_PCM_FORMAT_S16_LE, 2}, {SND_PCM_FORMAT_S32_LE, 4}, {SND_PCM_FORMAT_S24_3LE, 3}};
  snd_pcm_hw_params_t* hardware = nullptr;
  snd_pcm_hw_params_alloca(&hardware);
  error_ = "it does not say what it can do";
  int error = snd_pcm_hw_params_any(handle_, hardware);
  if (error < 0) return error;
  unsigned most = 0;
  snd_pcm_hw_params_get_channels_max(hardware, &most);
  error_ = "it has " + std::to_string(most) + " channels, and channel " +
           std::to_string(least_channels) + " is asked for";
  if (most < least_channels) return -EINVAL;
  error_ = "it does not play integers of 16, 24 or 32 bits at 48 kHz";
  error = snd_pcm_hw_params_set_access(handle_, hardware, SND_PCM_ACCESS_RW_INTERLEAVED);
  for (const auto& [format, size] : kFormats) {
    if (snd_pcm_hw_params_test_format(handle_, hardware, format) != 0) continue;
    if (error >= 0) error = snd_pcm_hw_params_set_format(handle_, hardware, format);
    bytes_ = size;
    break;
  }
  if (error < 0 || bytes_ == 0) return error < 0 ? error : -EINVAL;
  channels_ = least_channels;
  while (channels_ < most && snd_pcm_hw_params_test_channels(handle_, hardware, channels_) != 0) {
    ++channels_;
  }
  error = snd_pcm_hw_params_set_channels(handle_, hardware, channels_);
  if (error >= 0) error = snd_pcm_hw_params_set_rate(handle_, hardware, sound::kRate_Hz, 0);
  if (error < 0) return error;
  error_ = "it takes no buffer of a size that it was asked for";
  period_ = sound::kBlockFrames;
  error = snd_pcm_hw_params_set_period_size_near(handle_, hardware, &period_, nullptr);
  buffer_ = std::max<snd_pcm_uframes_t>(3 * period_, period_ + kAhead);
  if (error >= 0) error = snd_pcm_hw_params_set_buffer_size_near(handle_, hardware, &buffer_);
  if (error >= 0) error = snd_pcm_hw_params(handle_, hardware);
  return error;
}

/// The device starts when its buffer lacks only one block, and stops by itself when the buffer is
/// empty. Between two of its periods it may report less than it has taken.
int SoundTransport::Pcm::set_software() {
  error_ = "its buffer is too small";
  int error = snd_pcm_get_params(handle_, &buffer_, &period_);
  if (error < 0) return error;
  held_ = static_cast<snd_pcm_sframes_t>(
      std::min(buffer_, std::max<snd_pcm_uframes_t>(period_, sound::kBlockFrames) + kAhead));
  // Before it runs, the device reports room only for whole periods.
  const snd_pcm_uframes_t most = (buffer_ - period_) / sound::kBlockFrames + 1;
  const auto started = std::min<snd_pcm_uframes_t>(
      static_cast<snd_pcm_uframes_t>(held_ - sound::kBlockFrames), most * sound::kBlockFrames);
  if (held_ < 2 * sound::kBlockFrames || started < period_) return -EINVAL;
  error_ = "it does not take its settings";
  snd_pcm_sw_params_t* software = nullptr;
  snd_pcm_sw_params_alloca(&software);
  error = snd_pcm_sw_params_current(handle_, software);
  if (error >= 0) error = snd_pcm_sw_params_set_start_threshold(handle_, software, started);
  if (error >= 0) error = snd_pcm_sw_params_set_stop_threshold(handle_, software, buffer_);
  if (error >= 0) error = snd_pcm_sw_params_set_avail_min(handle_, software, buffer_ - started);
  return error >= 0 ? snd_pcm_sw_params(handle_, software) : error;
}

std::optional<snd_pcm_sframes_t> SoundTransport::Pcm::wait_for_space() noexcept {
  const int woken = snd_pcm_wait(handle_, kTimeout_ms);
  if (woken == 0) return std::nullopt;
  snd_pcm_sframes_t free = 0, waiting = 0;
  const int error = woken < 0 ? woken : snd_pcm_avail_delay(handle_, &free, &waiting);
  if (error < 0) return error;
  const int64_t now_ns = monotonic_now_ns();
  const snd_pcm_sframes_t has = static_cast<snd_pcm_sframes_t>(buffer_) - free;
  if (has + sound::kBlockFrames <= held_ && now_ns >= next_ns_) {
    return std::max<snd_pcm_sframes_t>(waiting, 0);
  }
  // poll() was woken by something else, the buffer is much larger, or the device has no clock.
  sleep_until_ns(now_ns + kMillisecond_ns);
  return std::nullopt;
}

int SoundTransport::Pcm::write(const uint8_t* block) noexcept {
  const snd_pcm_sframes_t written = snd_pcm_writei(handle_, block, sound::kBlockFrames);
  if (written < 0) return static_cast<int>(written);
  // Limits the pace even when ALSA writes to a file; no card's clock is wrong by 2 %.
  next_ns_ = std::max(next_ns_, monotonic_now_ns() - held_ns()) + kBlock_ns * 49 / 50;
  return 0;
}

bool SoundTransport::Pcm::recover(int error) noexcept {
  // While a suspended computer wakes up, ALSA itself would wait for the card without a limit.
  if (error == -ESTRPIPE && snd_pcm_resume(handle_) == -EAGAIN) return true;
  return snd_pcm_recover(handle_, error, 1) >= 0;
}

void SoundTransport::Pcm::drain() noexcept {
  snd_pcm_sframes_t left = 0;
  if (snd_pcm_delay(handle_, &left) == 0) {
    sleep_until_ns(monotonic_now_ns() +
                   std::clamp<int64_t>(ns_of(left), 0, 2 * kTimeout_ms * kMillisecond_ns));
  }
  snd_pcm_drop(handle_);
}

SoundTransport::SoundTransport(std::string name, sound::Settings settings)
    : name_(std::move(name)), settings_(std::move(settings)) {}

SoundTransport::~SoundTransport() {
  close();
}

void SoundTransport::open() {
  close();
  const QuietAlsa quiet;
  const std::string& id = settings_.card;
  const std::vector<SoundCard> cards = list_sound_cards();
  if (plays_elsewhere(id)) {
    throw DeviceError(
        name_ + ": \"" + id +
            "\" plays on whatever a server or a setting chooses; name the card: " + names_of(cards),
        DeviceErrorCode::kSettings);
  }
  const SoundCard card = resolve_card(name_, id, first_, cards);
  pcm_ = std::make_unique<Pcm>(name_, card, settings_.channels);
  first_.require(name_, card.identity());
  fed_.store({});
  lag_ns_ = 0;
  underruns_ = 0;
  stop_ = false;
  fault_ = LinkFault::kNone;
  thread_ = start_thread("spidar-sound", [this] {
    request_exact_timers();
    request_real_time();
    play();
  });
}

Transfer SoundTransport::transfer(std::initializer_list<ByteView> packets, MutableBytes reply,
                                  int64_t) noexcept {
  const LinkFault fault = fault_;
  if (fault != LinkFault::kNone) return {fault, 0};
  Fed fed{{}, monotonic_now_ns()};
  const ByteView packet = *packets.begin();
  std::copy_n(packet.data, std::min(packet.size, sizeof fed.levels),
              reinterpret_cast<uint8_t*>(&fed.levels));
  fed_.store(fed);
  const sound::State state{lag_ns_, underruns_, pcm_->period_ms()};
  const ByteView answer = sound::view_of(state);
  const size_t length = std::min(answer.size, reply.size);
  std::copy_n(answer.data, length, reply.data);
  return {LinkFault::kNone, length};
}

/// Averages the lag, because each value contains the lateness of one wake-up.
void SoundTransport::set_lag(int64_t lag_ns) noexcept {
  constexpr int kAveraged = 16;
  lag_ns_ = lag_ns_ == 0 ? lag_ns : lag_ns_ + (lag_ns - lag_ns_) / kAveraged;
}

void SoundTransport::play() noexcept {
  const QuietAlsa quiet;
  sound::Carrier carrier(settings_.carrier_Hz);
  std::vector<uint8_t> block(pcm_->block_bytes());
  Fed fed;
  int64_t written_ns = monotonic_now_ns();
  while (!stop_ || !carrier.rests()) {
    const std::optional<snd_pcm_sframes_t> before = pcm_->wait_for_space();
    const int64_t now_ns = monotonic_now_ns(), idle_ns = now_ns - written_ns;
    if (idle_ns > pcm_->held_ns() + kTimeout_ms * kMillisecond_ns) {
      if (stop_) break;
      fault_ = LinkFault::kTimeout;
    }
    if (!before) continue;
    int error = static_cast<int>(std::min<snd_pcm_sframes_t>(*before, 0));
    if (error == 0) {
      fed_.try_load(fed);  // keeps the previous levels while new ones are being written
      const bool fresh = !stop_ && now_ns - fed.at_ns < sound::kSilence_ms * kMillisecond_ns;
      const std::optional<int> half_way = carrier.write(
          fresh ? fed.levels : sound::Levels(), pcm_->channels(), pcm_->bytes(), block.data());
      error = pcm_->write(block.data());
      if (error == 0) {
        // On average, a level waits half a block for its block.
        if (half_way && pcm_->is_running()) set_lag(ns_of(*before + *half_way) + kBlock_ns / 2);
        written_ns = now_ns;
        fault_ = LinkFault::kNone;
        continue;
      }
    }
    // After an underrun or a suspended computer the sound continues from silence, never at once,
    // because the failed call may fail again. After every other error it does not continue.
    carrier = sound::Carrier(settings_.carrier_Hz);
    if (error == -EPIPE) ++underruns_;
    if (!pcm_->recover(error) || idle_ns > kHopeless_ms * kMillisecond_ns) {
      fault_ = LinkFault::kGone;
      return;
    }
    sleep_until_ns(now_ns + kBlock_ns);
  }
  pcm_->drain();
}

void SoundTransport::close() noexcept {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
  pcm_.reset();
  fault_ = LinkFault::kGone;
}

}  // namespace spidar
