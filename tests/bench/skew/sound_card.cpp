// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/skew/sound_card.h"

#include <algorithm>
#include <cstdint>
#include <mutex>

#include <gst/audio/gstaudiosink.h>

#include "spidar/realtime/monotonic.h"

namespace spidar::bench {
namespace {

/// Samples in the card's buffer, counted by channels together.
class CardBuffer {
 public:
  void prepare(double samples_per_s, int64_t capacity) {
    const std::lock_guard<std::mutex> lock(mutex_);
    samples_per_ns_ = 1e-9 * samples_per_s;
    capacity_ = capacity;
    empty();
  }

  void drop() {
    const std::lock_guard<std::mutex> lock(mutex_);
    empty();
  }

  /// Waits until there is room.
  void write(int64_t samples) {
    std::unique_lock<std::mutex> lock(mutex_);
    while (written_ > 0 && waiting() + samples > capacity_) {
      const auto room_at_ns = static_cast<int64_t>(
          static_cast<double>(written_ + samples - capacity_) / samples_per_ns_);
      const int64_t until_ns = began_ns_ + room_at_ns + 1;
      lock.unlock();  // drop() ends the wait with the next look: after a period at most
      sleep_until_ns(until_ns);
      lock.lock();
    }
    if (waiting() == 0) {  // the first, or the card has run dry
      written_ = 0;
      began_ns_ = monotonic_now_ns();
    }
    written_ += samples;
  }

  /// Written and not yet heard.
  int64_t delay() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return waiting();
  }

 private:
  void empty() { written_ = 0; }

  int64_t waiting() const {
    if (written_ == 0) return 0;
    const auto heard =
        static_cast<int64_t>(static_cast<double>(monotonic_now_ns() - began_ns_) * samples_per_ns_);
    return std::max<int64_t>(written_ - heard, 0);
  }

  std::mutex mutex_;
  double samples_per_ns_ = 0;
  int64_t capacity_ = 0;
  int64_t began_ns_ = 0;  // CLOCK_MONOTONIC at which the first of those written was heard
  int64_t written_ = 0;
};

struct SoundCard {
  GstAudioSink parent;
  CardBuffer* buffer;
  double drift;
  gint bytes_per_sample;  // of all channels
};
struct SoundCardClass {
  GstAudioSinkClass parent_class;
};

GstStaticPadTemplate sound_template = GST_STATIC_PAD_TEMPLATE(
    "sink", GST_PAD_SINK, GST_PAD_ALWAYS,
    GST_STATIC_CAPS("audio/x-raw, format=(string)S16LE, layout=(string)interleaved, "
                    "rate=(int)[ 8000, 192000 ], channels=(int)[ 1, 2 ]"));

G_DEFINE_TYPE(SoundCard, sound_card, GST_TYPE_AUDIO_SINK)

SoundCard* sound_card_of(gpointer object) {
  return G_TYPE_CHECK_INSTANCE_CAST(object, sound_card_get_type(), SoundCard);
}

gboolean sound_card_open(GstAudioSink*) {
  return TRUE;
}

gboolean sound_card_prepare(GstAudioSink* sink, GstAudioRingBufferSpec* spec) {
  SoundCard* const card = sound_card_of(sink);
  card->bytes_per_sample = GST_AUDIO_INFO_BPF(&spec->info);
  card->buffer->prepare(GST_AUDIO_INFO_RATE(&spec->info) * (1 + card->drift),
                        spec->segsize * spec->segtotal / card->bytes_per_sample);
  return TRUE;
}

gint sound_card_write(GstAudioSink* sink, gpointer, guint length) {
  SoundCard* const card = sound_card_of(sink);
  card->buffer->write(static_cast<gint>(length) / card->bytes_per_sample);
  return static_cast<gint>(length);
}

guint sound_card_delay(GstAudioSink* sink) {
  return static_cast<guint>(sound_card_of(sink)->buffer->delay());
}

void sound_card_reset(GstAudioSink* sink) {
  sound_card_of(sink)->buffer->drop();
}

gboolean sound_card_close(GstAudioSink*) {
  return TRUE;
}

void sound_card_finalize(GObject* object) {
  delete sound_card_of(object)->buffer;
  G_OBJECT_CLASS(sound_card_parent_class)->finalize(object);
}

void sound_card_class_init(SoundCardClass* klass) {
  G_OBJECT_CLASS(klass)->finalize = sound_card_finalize;
  GstAudioSinkClass* const audio_class = GST_AUDIO_SINK_CLASS(klass);
  audio_class->open = sound_card_open;
  audio_class->prepare = sound_card_prepare;
  audio_class->unprepare = sound_card_close;
  audio_class->close = sound_card_close;
  audio_class->write = sound_card_write;
  audio_class->delay = sound_card_delay;
  audio_class->reset = sound_card_reset;
  gst_element_class_add_static_pad_template(GST_ELEMENT_CLASS(klass), &sound_template);
  gst_element_class_set_static_metadata(GST_ELEMENT_CLASS(klass), "Sound card", "Sink/Audio",
                                        "Keeps the time of a sound card", "gst-spidar");
}

void sound_card_init(SoundCard* card) {
  card->buffer = new CardBuffer;
}

}  // namespace

GstElement* make_sound_card(double drift) {
  auto* const card = static_cast<SoundCard*>(g_object_new(sound_card_get_type(), nullptr));
  card->drift = drift;
  return GST_ELEMENT(card);
}

}  // namespace spidar::bench
