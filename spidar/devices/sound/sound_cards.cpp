// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/sound/sound_cards.h"

#include <algorithm>
#include <alsa/asoundlib.h>
#include <cstdlib>
#include <iterator>

#include "spidar/device_error.h"
#include "spidar/devices/sound/quiet_alsa.h"
#include "spidar/text.h"

namespace spidar {
namespace {

/// PCMs of ALSA's configuration and plugins that play on a device which a server or setting
/// chooses.
constexpr const char* kElsewhere[] = {"default",   "sysdefault", "pulse", "pipewire", "jack",
                                      "oss",       "null",       "dmix",  "lavrate",  "samplerate",
                                      "speexrate", "speex",      "upmix", "vdownmix", "usbstream"};

/// Returns the first playback device of a card; −1: none.
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

void add_cards(std::vector<SoundCard>& found) {
  snd_ctl_card_info_t* info = nullptr;
  snd_ctl_card_info_alloca(&info);
  for (int card = -1; snd_card_next(&card) == 0 && card >= 0;) {
    snd_ctl_t* control = nullptr;
    if (snd_ctl_open(&control, ("hw:" + std::to_string(card)).c_str(), SND_CTL_NONBLOCK) < 0) {
      continue;
    }
    const int device = playing_device(control);
    if (device >= 0 && snd_ctl_card_info(control, info) == 0) {
      const std::string id = snd_ctl_card_info_get_id(info);
      found.push_back({id, printable(snd_ctl_card_info_get_name(info)),
                       "hw:CARD=" + id + ",DEV=" + std::to_string(device),
                       printable(snd_ctl_card_info_get_longname(info))});
    }
    snd_ctl_close(control);
  }
}

/// Adds PCMs that a person has configured with a hint; names with a colon or comma belong to cards.
void add_configured(std::vector<SoundCard>& found) {
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
    if (!plays_elsewhere(id)) {
      found.push_back({id, printable(name.substr(0, name.find('\n'))), id, "pcm." + id});
    }
  }
  snd_device_name_free_hint(hints);
}

}  // namespace

std::string names_of(const std::vector<SoundCard>& cards) {
  std::string names;
  for (const SoundCard& card : cards) names += (names.empty() ? "sound:" : ", sound:") + card.id;
  return names.empty() ? "no card was found" : "there are " + names;
}

SoundCard resolve_card(const std::string& device, const std::string& id, const FirstDevice& first,
                       const std::vector<SoundCard>& cards) {
  const auto named =
      std::find_if(cards.begin(), cards.end(), [&](const SoundCard& one) { return one.id == id; });
  if (first.known()) {
    const auto same = std::find_if(cards.begin(), cards.end(),
                                   [&](const SoundCard& one) { return first.is(one.identity()); });
    if (same != cards.end()) return *same;
    if (named != cards.end()) throw first.other(device, named->identity());
  }
  if (named == cards.end()) {
    throw DeviceError(device + ": there is no sound card \"" + id + "\"; " + names_of(cards),
                      DeviceErrorCode::kAbsent);
  }
  return *named;
}

bool plays_elsewhere(const std::string& id) {
  return std::find(std::begin(kElsewhere), std::end(kElsewhere), id) != std::end(kElsewhere);
}

std::optional<int> card_number(const std::string& id) {
  const int number = snd_card_get_index(id.c_str());
  return number < 0 ? std::nullopt : std::optional(number);
}

std::vector<SoundCard> list_sound_cards() {
  const QuietAlsa quiet;
  std::vector<SoundCard> found;
  add_cards(found);
  add_configured(found);
  return found;
}

}  // namespace spidar
