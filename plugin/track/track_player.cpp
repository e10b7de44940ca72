// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/track/track_player.h"

#include <initializer_list>
#include <string>
#include <utility>

#include "plugin/reports/category.h"
#include "plugin/track/sidecar.h"

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

/// Of these properties, those that are not at their defaults, and not as in the line `known`.
std::string list_set(GstElement* element, std::initializer_list<const char*> names,
                     const std::string& known) {
  std::string list;
  for (const char* const name : names) {
    GParamSpec* const spec = g_object_class_find_property(G_OBJECT_GET_CLASS(element), name);
    GValue value = G_VALUE_INIT;
    g_value_init(&value, spec->value_type);
    g_object_get_property(G_OBJECT(element), name, &value);
    gchar* const text =
        G_VALUE_HOLDS_STRING(&value) ? g_value_dup_string(&value) : gst_value_serialize(&value);
    const std::string setting = std::string(name) + "=" + (text ? text : "");
    const bool is_known = (" " + known + " ").find(" " + setting + " ") != std::string::npos;
    if (!is_known && !g_param_value_defaults(spec, &value)) {
      list += (list.empty() ? "" : ", ") + setting;
    }
    g_free(text);
    g_value_unset(&value);
  }
  return list;
}

/// What is set and changes nothing.
void name_unused(GstElement* element, const std::string& settings, const char* kind,
                 const std::string& path) {
  if (settings.empty()) return;
  GST_ELEMENT_WARNING(
      element, RESOURCE, SETTINGS,
      ("%s has no effect while the %s %s is played.", settings.c_str(), kind, path.c_str()),
      ("Leave out the one or the other, or make the %s anew with it.", kind));
}

}  // namespace

void TrackPlayer::set_track(TrackFile track) {
  replay_.set_track(std::move(track));
  active_ = replay_.has_track();
  frames_ = 0;
}

Wrench TrackPlayer::play(const FramePlace& frame) {
  ++frames_;
  replay_.play(frame, [this](const TrackBlock& block) { schedule_.add(block); });
  return replay_.largest(frame);
}

std::optional<FramePlace> place_of(GstBuffer* frame, GstClockTime default_duration,
                                   const GstSegment& segment, int64_t running_ns,
                                   double rate_multiplier) {
  const GstClockTime pts = GST_BUFFER_PTS(frame);
  GstClockTime duration = GST_BUFFER_DURATION(frame);
  if (!GST_CLOCK_TIME_IS_VALID(duration)) duration = default_duration;
  guint64 from = 0, to = 0;
  if (!gst_segment_clip(&segment, GST_FORMAT_TIME, pts, pts + duration, &from, &to)) {
    return std::nullopt;
  }
  const bool backwards = segment.rate < 0;
  FramePlace place;
  place.stream_ns = static_cast<int64_t>(
      gst_segment_to_stream_time(&segment, GST_FORMAT_TIME, backwards ? to : from));
  place.running_ns = running_ns;
  place.length_ns = static_cast<int64_t>(to - from);
  place.rate = segment.rate * rate_multiplier;
  return place;
}

std::shared_ptr<const MotionFile> judge_analysis(GstElement* element, const LoadedTrack& loaded,
                                                 MotionKind motion) {
  if (loaded.path.empty()) return nullptr;
  std::string problem = loaded.problem;
  if (problem.empty()) problem = wrong_motion(loaded.analysis->header(), motion);
  if (problem.empty()) {
    const bool mean = motion == MotionKind::kMean;
    const std::string known = loaded.analysis->header().settings;
    name_unused(element,
                mean ? list_set(element, {"max-features", "min-distance", "quality-level"}, known)
                     : list_set(element, {"max-features", "quality"}, known),
                "analysis", loaded.path);
    return loaded.analysis;
  }
  GST_ELEMENT_WARNING(element, RESOURCE, SETTINGS,
                      ("The analysis %s is not used: %s.", loaded.path.c_str(), problem.c_str()),
                      ("The video is analysed in its place."));
  return nullptr;
}

std::optional<TrackFile> judge_track(GstElement* element, LoadedTrack loaded, int64_t frame_ns) {
  if (loaded.path.empty()) return std::nullopt;
  if (loaded.problem.empty() && !loaded.is_compared) {
    GstPad* pad = gst_element_get_static_pad(element, "sink");
    loaded.problem = other_film(pad, loaded.track->duration_ns, frame_ns);
    gst_object_unref(pad);
  }
  if (loaded.problem.empty()) {
    name_faults(element, loaded.path, loaded.track->faults);
    name_unused(element, list_set(element, {"feel"}, ""), "haptic track", loaded.path);
    return std::move(loaded.track);
  }
  GST_ELEMENT_WARNING(
      element, RESOURCE, SETTINGS,
      ("The haptic track %s is not felt: %s.", loaded.path.c_str(), loaded.problem.c_str()),
      ("The video is analysed in its place."));
  return std::nullopt;
}

}  // namespace spidar
