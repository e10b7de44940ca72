// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tracks/track_warnings.h"

#include <utility>

#include "plugin/films/stream_content.h"
#include "plugin/gobject/category.h"

// The category in which GST_ELEMENT_WARNING logs.
#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT spidar::category_of(element_)

namespace spidar::tracks {

void Warnings::warn_of_missing_mark() {
  if (std::exchange(unmarked_, true)) return;
  GST_ELEMENT_WARNING(
      element_, STREAM, WRONG_TYPE,
      ("This sound is not felt: nothing says that it is a haptic track. Tracks that spidarextract "
       "and spidartrack make have the tag %s. If this is one, set accept-unmarked=true, or mark "
       "the file: %s",
       kTrackMark, how_to_mark().c_str()),
      ("Sound for ears would push and pull the hand."));
}

void Warnings::warn_of_sync() {
  GST_ELEMENT_WARNING(element_, RESOURCE, SETTINGS,
                      ("sync=false has no effect: each sample of a haptic track is felt at its "
                       "time, at base time + "
                       "running time + latency + ts-offset."),
                      ("Without it, the whole track would be over at once."));
}

void Warnings::check(const Faults& faults, bool has_time, const std::string& path) {
  const std::string track = "The haptic track" + (path.empty() ? "" : " " + path);
  if (faults.not_finite > 0 && !not_finite_) {
    not_finite_ = true;
    GST_ELEMENT_WARNING(
        element_, STREAM, DECODE,
        ("%s has %" G_GUINT64_FORMAT " samples that are not numbers; they are played as rest.",
         track.c_str(), static_cast<guint64>(faults.not_finite)),
        ("NaN or infinite."));
  }
  if (faults.beyond_full > 0 && !beyond_full_) {
    beyond_full_ = true;
    GST_ELEMENT_WARNING(element_, STREAM, DECODE,
                        ("%s has %" G_GUINT64_FORMAT
                         " samples beyond full scale, 10 N and 1 N m; max-force limits them all "
                         "the same.",
                         track.c_str(), static_cast<guint64>(faults.beyond_full)),
                        ("Is it ordinary sound?"));
  }
  if (faults.sound_channel >= 0 && !is_sound_) {
    is_sound_ = true;
    GST_ELEMENT_WARNING(
        element_, STREAM, WRONG_TYPE,
        ("%s is sound for ears: more than %g %% of the energy of its channel %s is "
         "above 30 Hz, which no motion of a film is.",
         track.c_str(), 100 * kMaxFast, channel_name(static_cast<size_t>(faults.sound_channel))),
        ("See \"spidartrack check\"."));
  }
  if (!has_time && !no_time_) {
    no_time_ = true;
    GST_ELEMENT_WARNING(element_, STREAM, FORMAT,
                        ("Samples without a timestamp cannot be felt in time; they are left out."),
                        ("No PTS, or decades ahead, or a segment that is not in time. A parser "
                         "before the decoder, or rawaudioparse, adds them."));
  }
}

}  // namespace spidar::tracks
