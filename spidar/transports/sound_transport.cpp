// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/transports/sound_transport.h"

#include <algorithm>
#include <alsa/asoundlib.h>
#include <cstdlib>
#include <iterator>
#include <utility>

#include "spidar/device.h"
#include "spidar/realtime/monotonic.h"
#include "spidar/realtime/thread_setup.h"

namespace spidar {
namespace {

constexpr int64_t kMillisecond_ns = kSecond_ns / 1000;

/// PCMs of ALSA's configuration and its plugins that play somewhere else: on what a server or a
/// setting chooses.
constexpr const char* kElsewhere[] = {"default",   "sysdefault", "pulse", "pipewire", "jack",
                                      "oss",       "null",       "dmix",  "lavrate",  "samplerate",
                                      "speexrate", "speex",      "upmix", "vdownmix", "usbstream"};

bool plays_elsewhere(const std::string& id) {
  return std::find(std::begin(kElsewhere), std::end(kElsewhere), id) != std::end(kElsewhere);
}

/// Its messages go to the standard error otherwise; what matters is in the DeviceError.
void be_quiet(const char*, int, const char*, int, const char*, ...) {}

/// The first device of a card that plays; −1: none.
int playing_device(snd_ctl_t* control) {
  snd_pcm_info_t* info = nullptr;
  snd_pcm_info_alloca(&info);
  for (int device = -1; snd_ctl_pcm_next_device(control, &device) == 0 && device >= 0;) {
    snd_pcm_info_set_device(info, static_cast<unsigned>(device));
    snd_pcm_info_set_stream(info, SND_PCM_STREAM_PLAYBACK);
    if (snd_ctl_pcm_info(control, info) == 0) return device;
  }
  return -1;
}

struct FoundCard : SoundCard {
  std::string pcm;  ///< what ALSA calls it
};

void add_cards(std::vector<FoundCard>& found) {
  snd_ctl_card_info_t* info = nullptr;
  snd_ctl_card_info_alloca(&info);
  for (int card = -1; snd_card_next(&card) == 0 && card >= 0;) {
    snd_ctl_t* control = nullptr;
    if (snd_ctl_open(&control, ("hw:" + std::to_string(card)).c_str(), SND_CTL_NONBLOCK) < 0)
      continue;
    const int device = playing_device(control);
    if (device >= 0 && snd_ctl_card_info(control, info) == 0) {
      const std::string id = snd_ctl_card_info_get_id(info);
      found.push_back({{id, snd_ctl_card_info_get_name(info)},
                       "hw:CARD=" + id + ",DEV=" + std::to_string(device)});
    }
    snd_ctl_close(control);
  }
}

/// Those that a person has configured, with a hint; names with a colon are of cards.
void add_configured(std::vector<FoundCard>& found) {
  void** hints = nullptr;
  if (snd_device_name_hint(-1, "pcm", &hints) < 0) return;
  const auto text_of = [](const void* hint, const char* key) {
    char* const text = snd_device_name_get_hint(hint, key);
    const std::string kept = text ? text : "";
    std::free(text);
    return kept;
  };
  for (void** hint = hints; *hint; ++hint) {
    const std::string id = text_of(*hint, "NAME"), name = text_of(*hint, "DESC");
    if (text_of(*hint, "IOID") == "Input" || id.find_first_of(":,") != std::string::npos) continue;
    if (!plays_elsewhere(id)) found.push_back({{id, name.substr(0, name.find('\n'))}, id});
  }
  snd_device_name_free_hint(hints);
}

std::vector<FoundCard> find_cards() {
  snd_lib_error_set_handler(be_quiet);
  std::vector<FoundCard> found;
  add_cards(found);
  add_configured(found);
  return found;
}

std::string names_of(const std::vector<FoundCard>& cards) {
  std::string names;
  for (const FoundCard& card : cards) names += (names.empty() ? "sound:" : ", sound:") + card.id;
  return names.empty() ? "no card was found" : "there are " + names;
}

}  // namespace

std::vector<SoundCard> list_sound_cards() {
  const std::vector<FoundCard> found = find_cards();
  return {found.begin(), found.end()};
}

struct SoundTransport::Pcm {
  ~Pcm() {
    if (handle) snd_pcm_close(handle);
  }

  void configure(int least_channels);
  /// What ALSA returns, or 0.
  int set_hardware(unsigned least_channels);
  int set_software();

  snd_pcm_t* handle = nullptr;
  unsigned channels = 0;
  int bytes = 0;  ///< of a sample
  std::string trouble;
  std::vector<uint8_t> block;
};

/// The fewest channels that the device itself has, because a conversion would play them elsewhere.
int SoundTransport::Pcm::set_hardware(unsigned least_channels) {
  constexpr std::pair<snd_pcm_format_t, int> kFormats[] = {
      {SND_PCM_FORMAT_S16_LE, 2}, {SND_PCM_FORMAT_S32_LE, 4}, {SND_PCM_FORMAT_S24_3LE, 3}};
  snd_pcm_hw_params_t* hardware = nullptr;
  snd_pcm_hw_params_alloca(&hardware);
  int error = snd_pcm_hw_params_any(handle, hardware);
  if (error < 0) return error;
  unsigned most = 0;
  snd_pcm_hw_params_get_channels_max(hardware, &most);
  trouble = "it has " + std::to_string(most) + " channels, and channel " +
            std::to_string(least_channels) + " is asked for";
  if (most < least_channels) return -EINVAL;
  trouble = "it does not play integers of 16, 24 or 32 bits at 48 kHz";
  error = snd_pcm_hw_params_set_access(handle, hardware, SND_PCM_ACCESS_RW_INTERLEAVED);
  for (const auto& [format, size] : kFormats) {
    if (snd_pcm_hw_params_test_format(handle, hardware, format) != 0) continue;
    if (error >= 0) error = snd_pcm_hw_params_set_format(handle, hardware, format);
    bytes = size;
    break;
  }
  if (error < 0 || bytes == 0) return -EINVAL;
  channels = least_channels;
  while (channels < most && snd_pcm_hw_params_test_channels(handle, hardware, channels) != 0)
    ++channels;
  error = snd_pcm_hw_params_set_channels(handle, hardware, channels);
  if (error >= 0) error = snd_pcm_hw_params_set_rate(handle, hardware, sound::kRate_Hz, 0);
  snd_pcm_uframes_t period = sound::kRampFrames,
                    buffer = sound::kRampFrames * kBuffer_ms / sound::kRamp_ms;
  if (error >= 0)
    error = snd_pcm_hw_params_set_period_size_near(handle, hardware, &period, nullptr);
  if (error >= 0) error = snd_pcm_hw_params_set_buffer_size_near(handle, hardware, &buffer);
  if (error >= 0) error = snd_pcm_hw_params(handle, hardware);
  block.assign(channels * static_cast<size_t>(bytes) * sound::kRampFrames, 0);
  return error;
}

/// Starts with two blocks, takes a third, however large the buffer is, and stops by itself when it
/// has played all that it has.
int SoundTransport::Pcm::set_software() {
  trouble = "its buffer is too small";
  snd_pcm_uframes_t buffer = 0, period = 0;
  int error = snd_pcm_get_params(handle, &buffer, &period);
  if (error >= 0 && buffer < 2 * sound::kRampFrames) error = -EINVAL;
  snd_pcm_sw_params_t* software = nullptr;
  snd_pcm_sw_params_alloca(&software);
  if (error >= 0) error = snd_pcm_sw_params_current(handle, software);
  if (error >= 0)
    error = snd_pcm_sw_params_set_start_threshold(handle, software, 2 * sound::kRampFrames);
  if (error >= 0) error = snd_pcm_sw_params_set_stop_threshold(handle, software, buffer);
  if (error >= 0)
    error = snd_pcm_sw_params_set_avail_min(
        handle, software,
        std::max<snd_pcm_uframes_t>(sound::kRampFrames, buffer - 2 * sound::kRampFrames));
  return error >= 0 ? snd_pcm_sw_params(handle, software) : error;
}

SoundTransport::SoundTransport(std::string name, sound::Settings settings)
    : name_(std::move(name)), settings_(std::move(settings)) {}

SoundTransport::~SoundTransport() {
  close();
}

void SoundTransport::open() {
  close();
  const std::string& id = settings_.card;
  if (plays_elsewhere(id))
    throw DeviceError(name_ + ": \"" + id +
                          "\" plays on whatever a server or a setting chooses; name the card: " +
                          names_of(find_cards()),
                      DeviceTrouble::kSettings);
  const std::vector<FoundCard> cards = find_cards();
  const auto card =
      std::find_if(cards.begin(), cards.end(), [&](const FoundCard& one) { return one.id == id; });
  if (card == cards.end())
    throw DeviceError(name_ + ": there is no sound card \"" + id + "\"; " + names_of(cards),
                      DeviceTrouble::kAbsent);
  auto pcm = std::make_unique<Pcm>();
  const int error =
      snd_pcm_open(&pcm->handle, card->pcm.c_str(), SND_PCM_STREAM_PLAYBACK, SND_PCM_NONBLOCK);
  if (error < 0) {
    pcm->handle = nullptr;
    throw DeviceError(
        name_ + ": cannot be opened: " + snd_strerror(error) +
            (error == -EBUSY
                 ? "; another program plays on it, perhaps the sound server: choose another "
                   "card there, or wait until it is silent"
                 : ""),
        trouble_of(-error));
  }
  int wrong = pcm->set_hardware(static_cast<unsigned>(settings_.channels));
  if (wrong >= 0) wrong = pcm->set_software();
  if (wrong < 0)
    throw DeviceError(
        name_ + ": cannot be used: " + pcm->trouble + " (" + snd_strerror(wrong) + ")",
        DeviceTrouble::kSettings);
  pcm_ = std::move(pcm);
  fed_.store({});
  lag_ns_ = 0;
  stop_ = false;
  fault_ = LinkFault::kNone;
  thread_ = start_thread("spidar-sound", [this] {
    request_exact_timers();
    request_real_time();
    play();
  });
}

Transfer SoundTransport::exchange(std::initializer_list<ByteView> packets, MutableBytes reply,
                                  int64_t) noexcept {
  const LinkFault fault = fault_;
  if (fault != LinkFault::kNone) return {fault, 0};
  Fed fed{{}, monotonic_now_ns()};
  const ByteView packet = *packets.begin();
  std::copy_n(packet.data, std::min(packet.size, sizeof fed.levels),
              reinterpret_cast<uint8_t*>(&fed.levels));
  fed_.store(fed);
  const sound::State state{lag_ns_};
  const ByteView answer = sound::view_of(state);
  const size_t length = std::min(answer.size, reply.size);
  std::copy_n(answer.data, length, reply.data);
  return {LinkFault::kNone, length};
}

/// Each wake-up is a little late, which the card's answer contains; the mean is what the loop can
/// count on.
void SoundTransport::set_lag(int64_t lag_ns) noexcept {
  constexpr int kAveraged = 16;
  lag_ns_ = lag_ns_ == 0 ? lag_ns : lag_ns_ + (lag_ns - lag_ns_) / kAveraged;
}

void SoundTransport::play() noexcept {
  sound::Carrier carrier(settings_.carrier_Hz);
  snd_pcm_t* const handle = pcm_->handle;
  int error = 0;
  int64_t written_ns = monotonic_now_ns();
  Fed fed;
  while (!stop_ || !carrier.rests()) {
    const int room = snd_pcm_wait(handle, kPatience_ms);
    if (monotonic_now_ns() - written_ns > kPatience_ms * kMillisecond_ns) {
      if (stop_) break;
      fault_ = LinkFault::kTimeout;
    }
    if (room == 0) continue;
    snd_pcm_sframes_t free = 0, waiting = 0;
    error = room < 0 ? room : snd_pcm_avail_delay(handle, &free, &waiting);
    if (error == 0 && free < sound::kRampFrames) {
      sleep_until_ns(monotonic_now_ns() + kMillisecond_ns);  // woken for something else
      continue;
    }
    if (error == 0) {
      fed_.try_load(fed);  // keeps the previous one while a new one is being written
      const bool fresh =
          !stop_ && monotonic_now_ns() - fed.at_ns < sound::kSilence_ms * kMillisecond_ns;
      carrier.write(fresh ? fed.levels : sound::Levels(), static_cast<int>(pcm_->channels),
                    pcm_->bytes, pcm_->block.data());
      const snd_pcm_sframes_t written =
          snd_pcm_writei(handle, pcm_->block.data(), sound::kRampFrames);
      if (written >= 0) {
        // A level is reached at the end of the block.
        if (snd_pcm_state(handle) == SND_PCM_STATE_RUNNING)
          set_lag((waiting + sound::kRampFrames) * kSecond_ns / sound::kRate_Hz);
        written_ns = monotonic_now_ns();
        fault_ = LinkFault::kNone;
        continue;
      }
      error = static_cast<int>(written);
    }
    // An underrun, or a suspended computer: it goes on from silence. Everything else does not.
    carrier = sound::Carrier(settings_.carrier_Hz);
    if (snd_pcm_recover(handle, error, 1) < 0) {
      fault_ = LinkFault::kGone;
      return;
    }
  }
  snd_pcm_sframes_t left = 0;
  if (snd_pcm_delay(handle, &left) == 0)
    sleep_until_ns(monotonic_now_ns() + std::clamp<int64_t>(left * kSecond_ns / sound::kRate_Hz, 0,
                                                            2 * kPatience_ms * kMillisecond_ns));
  snd_pcm_drop(handle);
}

void SoundTransport::close() noexcept {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
  pcm_.reset();
  fault_ = LinkFault::kGone;
}

}  // namespace spidar
