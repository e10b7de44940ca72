// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/track/film_streams.h"

#include <utility>

#include "core/track/track_format.h"
#include "plugin/track/track_input.h"

namespace spidar {
namespace {

struct Sound {
  int channels = 0, rate_Hz = 0;
};

Sound sound_of(const GstCaps* caps) {
  Sound sound;
  const GstStructure* structure = gst_caps_get_structure(caps, 0);
  gst_structure_get_int(structure, "channels", &sound.channels);
  gst_structure_get_int(structure, "rate", &sound.rate_Hz);
  return sound;
}

}  // namespace

StreamKind kind_of(const GstCaps* caps) {
  if (!caps || gst_caps_is_empty(caps) || gst_caps_is_any(caps)) return StreamKind::kOther;
  const std::string name = gst_structure_get_name(gst_caps_get_structure(caps, 0));
  if (name.rfind("video/", 0) == 0 || name.rfind("image/", 0) == 0) return StreamKind::kVideo;
  if (name.rfind("audio/", 0) != 0) return StreamKind::kOther;
  const Sound sound = sound_of(caps);
  const bool haptic = sound.channels == static_cast<int>(kTrackChannels) && sound.rate_Hz > 0 &&
                      sound.rate_Hz <= TrackInput::kHighestRate_Hz;
  return haptic ? StreamKind::kHapticTrack : StreamKind::kSound;
}

std::string describe_sound(const GstCaps* caps) {
  const Sound sound = sound_of(caps);
  if (sound.channels <= 0 || sound.rate_Hz <= 0) return {};
  return std::to_string(sound.channels) + " channels, " + std::to_string(sound.rate_Hz) + " Hz";
}

StreamsWatch::StreamsWatch(GstElement* parsebin, std::function<void()> known)
    : known_(std::move(known)) {
  g_signal_connect(parsebin, "pad-added", G_CALLBACK(added), this);
}

void StreamsWatch::added(GstElement*, GstPad* pad, gpointer self) {
  constexpr auto kData =
      static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_BUFFER_LIST |
                                   GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM);
  gst_pad_add_probe(pad, kData, flows, self, nullptr);
}

GstPadProbeReturn StreamsWatch::flows(GstPad*, GstPadProbeInfo* info, gpointer self) {
  if (info->type & GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM) {
    const GstEventType type = GST_EVENT_TYPE(GST_PAD_PROBE_INFO_EVENT(info));
    if (type != GST_EVENT_EOS && type != GST_EVENT_GAP) return GST_PAD_PROBE_OK;
  }
  auto& watch = *static_cast<StreamsWatch*>(self);
  std::call_once(watch.once_, [&watch] { watch.known_(); });
  return GST_PAD_PROBE_REMOVE;
}

GstCaps* caps_of(GstPad* pad) {
  GstCaps* caps = gst_pad_get_current_caps(pad);
  // Caps reach the pad of a parsebin with the first data, but its parser has them earlier.
  GstPad* target =
      !caps && GST_IS_GHOST_PAD(pad) ? gst_ghost_pad_get_target(GST_GHOST_PAD(pad)) : nullptr;
  if (target) {
    caps = gst_pad_get_current_caps(target);
    gst_object_unref(target);
  }
  return caps ? caps : gst_pad_query_caps(pad, nullptr);
}

}  // namespace spidar
