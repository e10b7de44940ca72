// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/film_stills.h"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "plugin/tools/track_samples.h"
#include "plugin/tracks/sidecar.h"

namespace spidar {
namespace {

/// Until a picture is there: of a long film with few key frames much is decoded first.
constexpr GstClockTime kLongest = 30 * GST_SECOND;

/// A film in PAUSED, whose sink has a picture.
class StillFilm {
 public:
  StillFilm(const std::string& film, int width) : film_(film) {
    const std::string line =
        "filesrc name=film ! decodebin ! video/x-raw ! videoconvert ! videoscale add-borders=false "
        "! "
        "video/x-raw,format=RGB,pixel-aspect-ratio=1/1,width=" +
        std::to_string(width) + " ! fakesink name=sink sync=false";
    GError* error = nullptr;
    pipeline_ = gst_parse_launch(line.c_str(), &error);
    if (error) {
      const std::string text = error->message;
      g_error_free(error);
      if (pipeline_) gst_object_unref(pipeline_);
      throw std::runtime_error(text);
    }
    set_location(pipeline_, "film", film);
    sink_ = gst_bin_get_by_name(GST_BIN(pipeline_), "sink");
    GstPad* const pad = gst_element_get_static_pad(sink_, "sink");
    gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM, drop_gaps, nullptr, nullptr);
    gst_object_unref(pad);
    gst_element_set_state(pipeline_, GST_STATE_PAUSED);
  }
  ~StillFilm() {
    gst_element_set_state(pipeline_, GST_STATE_NULL);
    gst_object_unref(sink_);
    gst_object_unref(pipeline_);
  }
  StillFilm(const StillFilm&) = delete;
  StillFilm& operator=(const StillFilm&) = delete;

  /// Returns when there is a picture.
  void await() const {
    try {
      await_message(pipeline_, GST_MESSAGE_ASYNC_DONE, kLongest);
    } catch (const std::runtime_error& e) {
      throw std::runtime_error(film_ + ": " + e.what());
    }
  }
  void seek(int64_t time_ns) const {
    if (!gst_element_seek_simple(
            pipeline_, GST_FORMAT_TIME,
            static_cast<GstSeekFlags>(GST_SEEK_FLAG_FLUSH | GST_SEEK_FLAG_ACCURATE), time_ns)) {
      throw std::runtime_error(film_ + ": cannot be searched, as is needed for its stills");
    }
    await();
  }
  /// Adds the picture that is there.
  void take(FilmStills& stills) const {
    GstSample* taken = nullptr;
    g_object_get(sink_, "last-sample", &taken, nullptr);
    const std::unique_ptr<GstSample, decltype(&gst_sample_unref)> sample(taken, gst_sample_unref);
    GstMapInfo map;
    if (!sample || !gst_buffer_map(gst_sample_get_buffer(sample.get()), &map, GST_MAP_READ)) {
      throw std::runtime_error(film_ + ": has no picture at a time that its track has");
    }
    const GstStructure* caps = gst_caps_get_structure(gst_sample_get_caps(sample.get()), 0);
    gst_structure_get_int(caps, "width", &stills.width);
    gst_structure_get_int(caps, "height", &stills.height);
    stills.rgb.emplace_back(map.data, map.data + map.size);
    gst_buffer_unmap(gst_sample_get_buffer(sample.get()), &map);
  }

 private:
  /// A sink that has a gap instead of a picture is in PAUSED, too. After a seek, matroskademux
  /// tells gaps of pictures that it comes to later.
  static GstPadProbeReturn drop_gaps(GstPad*, GstPadProbeInfo* info, gpointer) {
    const bool is_gap = GST_EVENT_TYPE(GST_PAD_PROBE_INFO_EVENT(info)) == GST_EVENT_GAP;
    return is_gap ? GST_PAD_PROBE_DROP : GST_PAD_PROBE_OK;
  }

  const std::string film_;
  GstElement* pipeline_ = nullptr;
  GstElement* sink_ = nullptr;
};

Film read(const std::string& film) {
  try {
    return read_film(film);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(film + ": " + error.what());
  }
}

}  // namespace

FilmStills film_stills(const std::string& film, int64_t track_ns, const TrackNotes& notes,
                       int count, int width) {
  FilmStills stills;
  const Film compared = read(film);
  const FilmMatch match = match_film(compared, track_ns, notes);
  if (!match.problem.empty()) {
    throw std::runtime_error(film + " is another film: " + match.problem);
  }
  const StillFilm still(film, width);
  still.await();
  for (int i = 0; i < count; ++i) {
    const int64_t time_ns = track_ns / count * i + track_ns / count / 2 + match.later_ns;
    // There is nothing to see before the first picture.
    still.seek(std::max(time_ns, compared.begin_ns));
    still.take(stills);
  }
  return stills;
}

}  // namespace spidar
