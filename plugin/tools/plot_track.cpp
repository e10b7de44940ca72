// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gst/gst.h>

#include "plugin/tools/gnuplot.h"
#include "plugin/tools/spidartrack_commands.h"
#include "plugin/tools/track_samples.h"
#include "plugin/tracks/sidecar.h"
#include "plugin/tracks/track_notes.h"
#include "spidar/tools/command_line.h"

namespace spidar {
namespace {

/// Pictures of one size, RGB, row by row from the top without gaps.
struct FilmStills {
  int width = 0, height = 0;
  std::vector<std::vector<uint8_t>> rgb;
};

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

/// `count` pictures, `width` pixels wide, from the middles of as many equal parts of a track of
/// `track_ns` with `notes`. `width` is a multiple of 4. Throws std::runtime_error: the film cannot
/// be played or searched, or the track is that of another one.
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

constexpr const char* kStyle = R"(set encoding utf8
set style data lines
set grid linecolor rgb '#d8d8d8' linetype 1 linewidth 0.5
set linetype 1 linecolor rgb '#0b5fa5' linewidth 1.5
set linetype 2 linecolor rgb '#d9541e' linewidth 1.5
set linetype 3 linecolor rgb '#009e73' linewidth 1.5
set lmargin at screen 0.09
set rmargin at screen 0.985
set key horizontal
set offsets 0, 0, graph 0.1, 0
)";

/// Sizes in pixels.
constexpr int kWidth = 1400, kCurves = 700, kGap = 14;
constexpr int kStills = 8;
constexpr int kStillWidth = 160;  // one of eight over the width of the curves

/// Bins of a curve: more than the picture has columns.
constexpr size_t kBins = 4000;

/// The lowest and the highest value of each bin, as two rows: time, force, torque. A short peak is
/// seen however long the track is.
void write_samples(std::ostream& script, const std::vector<TrackSample>& samples) {
  constexpr size_t kAxes = 6;
  const size_t step = samples.size() / kBins + 1;
  script << "$samples << END\n";
  for (size_t begin = 0; begin < samples.size(); begin += step) {
    std::array<double, kAxes> low, high;
    for (size_t i = begin; i < std::min(begin + step, samples.size()); ++i) {
      const Eigen::Matrix<double, 6, 1> value = to_wrench(samples[i]).stacked();
      for (size_t axis = 0; axis < kAxes; ++axis) {
        const double now = value[static_cast<Eigen::Index>(axis)];
        low[axis] = i == begin ? now : std::min(low[axis], now);
        high[axis] = i == begin ? now : std::max(high[axis], now);
      }
    }
    for (const auto& row : {low, high}) {
      script << static_cast<double>(begin) / kTrackRate_Hz;
      for (const double value : row) script << ' ' << value;
      script << '\n';
    }
  }
  script << "END\n";
}

/// Puts a plot between two heights of a picture, in pixels from its top.
void place(std::ostream& script, int top, int bottom, int height) {
  script << "set tmargin at screen " << 1 - static_cast<double>(top) / height
         << "\nset bmargin at screen " << 1 - static_cast<double>(bottom) / height << '\n';
}

/// The stills side by side, and a dotted line through the middle of each for the curves that
/// follow.
void draw_stills(std::ostream& script, const FilmStills& stills, double length_s) {
  const double part_s = length_s / kStills;
  const double pixel_s = 0.98 * part_s / stills.width;  // with a gap
  script << "set yrange [0:1]\nunset border\nunset tics\nplot ";
  for (int i = 0; i < kStills; ++i) {
    script << (i == 0 ? "" : ", ") << "'-' binary array=(" << stills.width << ',' << stills.height
           << ") format='%uchar%uchar%uchar' flipy origin=("
           << i * part_s + 0.01 * part_s + pixel_s / 2 << ',' << 0.5 / stills.height
           << ") dx=" << pixel_s << " dy=" << 1.0 / stills.height << " with rgbimage notitle";
  }
  script << '\n';
  for (const std::vector<uint8_t>& rgb : stills.rgb)
    script.write(reinterpret_cast<const char*>(rgb.data()),
                 static_cast<std::streamsize>(rgb.size()));
  script << "\nset border\nset tics\n";
  for (int i = 0; i < kStills; ++i) {
    const double t = (i + 0.5) * part_s;
    script << "set arrow from first " << t << ", graph 0 to first " << t
           << ", graph 1 nohead back linecolor rgb '#707070' dashtype 3\n";
  }
}

void draw(const std::vector<TrackSample>& samples, const FilmStills& stills,
          const std::string& png) {
  std::ostringstream script;
  const double length_s = static_cast<double>(samples.size()) / kTrackRate_Hz;
  // As high as its width between the margins makes a still.
  const int above = stills.rgb.empty() ? 0 : kStillWidth * stills.height / stills.width + kGap;
  const int height = kCurves + above;
  script << "set terminal pngcairo size " << kWidth << ',' << height << " font 'sans,12'\n"
         << kStyle << "set xrange [0:" << length_s << "]\n";
  write_samples(script, samples);
  script << "set multiplot\n";
  if (!stills.rgb.empty()) {
    place(script, kGap, above, height);
    draw_stills(script, stills, length_s);
  }
  const int middle = above + kCurves / 2;
  place(script, above + kGap, middle - 2 * kGap, height);
  // A range that is not empty if nothing is felt.
  script << "set yrange [*<-0.1 : 0.1<*]\nset ylabel 'force, N'\n"
            "plot $samples using 1:2 title 'x, right', '' using 1:3 title 'y, up', "
            "'' using 1:4 title 'z, towards the viewer'\n";
  place(script, middle + kGap, height - 4 * kGap, height);
  script << "set yrange [*<-1 : 1<*]\nset ylabel 'torque, mN m'\nset xlabel 'time, s'\n"
            "plot $samples using 1:(1000*$5) title 'about x', '' using 1:(1000*$6) title "
            "'about y', '' using 1:(1000*$7) title 'about z'\n";
  draw_with_gnuplot(script.str(), png);
}

}  // namespace

int plot_track(const PlotOptions& options) {
  const bool has_ending = std::filesystem::path(options.png).has_extension();
  if (has_ending && !ends_with(options.png, ".png")) {
    throw UsageError(options.png + ": the picture is a PNG, and its name ends in .png");
  }
  TrackCondition condition;
  const std::vector<TrackSample> samples = load_track(options.track, &condition);
  expect_own_track(condition);
  if (samples.empty()) throw std::runtime_error(options.track + ": has no samples to draw");
  FilmStills stills;
  if (!options.film.empty()) {
    stills = film_stills(options.film, static_cast<int64_t>(samples.size()) * kTrackPeriod_ns,
                         condition.notes, kStills, kStillWidth);
  }
  draw(samples, stills, options.png);
  return kDone;
}

}  // namespace spidar
