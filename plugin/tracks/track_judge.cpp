// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tracks/track_judge.h"

#include <string>
#include <utility>

#include "plugin/gobject/category.h"
#include "plugin/tracks/sidecar.h"

#undef GST_CAT_DEFAULT
#define GST_CAT_DEFAULT spidar::category_of(element)

namespace spidar {
namespace {

/// The track is felt in spite of it.
void name_faults(GstElement* element, const std::string& path, const TrackFaults& faults) {
  if (faults.not_finite > 0) {
    GST_ELEMENT_WARNING(element, STREAM, DECODE,
                        ("The haptic track %s has %" G_GUINT64_FORMAT
                         " samples that are not numbers; they are played as rest.",
                         path.c_str(), static_cast<guint64>(faults.not_finite)),
                        ("NaN or infinite."));
  }
  if (faults.beyond_full > 0) {
    GST_ELEMENT_WARNING(
        element, STREAM, DECODE,
        ("The haptic track %s has %" G_GUINT64_FORMAT
         " samples beyond full scale, 10 N and 1 N m; max-force holds all the same.",
         path.c_str(), static_cast<guint64>(faults.beyond_full)),
        ("Is it sound for ears?"));
  }
}

/// Names what is set and changes nothing while a track is played.
void name_unused(GstElement* element, const std::string& path) {
  gchar* feel = nullptr;
  g_object_get(element, "feel", &feel, nullptr);
  if (feel) {
    GST_ELEMENT_WARNING(
        element, RESOURCE, SETTINGS,
        ("feel=%s has no effect while the haptic track %s is played.", feel, path.c_str()),
        ("Leave out the one or the other, or make the haptic track anew with it."));
  }
  g_free(feel);
}

}  // namespace

std::optional<TrackFile> judge_track(GstElement* element, LoadedTrack loaded, int64_t frame_ns) {
  if (loaded.path.empty()) return std::nullopt;
  if (loaded.problem.empty() && !loaded.is_compared) {
    GstPad* pad = gst_element_get_static_pad(element, "sink");
    loaded.problem = other_film(pad, loaded.track->duration_ns, frame_ns);
    gst_object_unref(pad);
  }
  if (loaded.problem.empty()) {
    name_faults(element, loaded.path, loaded.track->faults);
    name_unused(element, loaded.path);
    return std::move(loaded.track);
  }
  GST_ELEMENT_WARNING(
      element, RESOURCE, SETTINGS,
      ("The haptic track %s is not felt: %s.", loaded.path.c_str(), loaded.problem.c_str()),
      ("The video is analysed in its place."));
  return std::nullopt;
}

}  // namespace spidar
