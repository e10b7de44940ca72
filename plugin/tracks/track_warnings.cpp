// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tracks/track_warnings.h"

#include "plugin/gobject/category.h"

#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT spidar::category_of(element_)

namespace spidar {

void TrackWarnings::check(const TrackFaults& faults, bool has_time, const std::string& path) {
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
  if (!has_time && !no_time_) {
    no_time_ = true;
    GST_ELEMENT_WARNING(element_, STREAM, FORMAT,
                        ("Samples without a timestamp cannot be felt in time; they are left out."),
                        ("No PTS, or decades ahead, or a segment that is not in time. A parser "
                         "before the decoder, or rawaudioparse, adds them."));
  }
}

}  // namespace spidar
