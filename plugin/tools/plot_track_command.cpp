// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <unistd.h>

#include "plugin/tools/film_stills.h"
#include "plugin/tools/gnuplot.h"
#include "plugin/tools/spidartrack_commands.h"
#include "plugin/tools/track_samples.h"
#include "plugin/track/part_file.h"
#include "spidar/tools/command_line.h"
#include "spidar/tools/exit_status.h"

namespace spidar {
namespace {

constexpr const char* kPlotTrackHelp = R"(usage: spidartrack plot TRACK PNG [--film FILM]

Draws force and torque over time. Needs gnuplot.

  --film FILM  draws stills of the film above, each over the moment it shows, which a dotted line marks
)";

constexpr const char* kStyle = R"(set encoding utf8
set style data lines
set grid linecolor rgb '#d8d8d8' linetype 1 linewidth 0.5
set linetype 1 linecolor rgb '#0b5fa5' linewidth 1.5
set linetype 2 linecolor rgb '#d9541e' linewidth 1.5
set linetype 3 linecolor rgb '#009e73' linewidth 1.5
set lmargin at screen 0.06
set rmargin at screen 0.985
set key horizontal
set offsets 0, 0, graph 0.1, 0
)";

/// Sizes in pixels.
constexpr int kWidth = 1400, kCurves = 700, kGap = 14;
constexpr int kStills = 8;
constexpr int kStillWidth = 160;  // one of eight over the width of the curves

/// The picture cannot show more points than this.
constexpr size_t kMostPoints = 20000;

void send(FILE* gnuplot, const std::vector<TrackSample>& samples, bool torque) {
  const size_t step = samples.size() / kMostPoints + 1;
  for (int curve = 0; curve < 3; ++curve) {  // once for each of the curves
    for (size_t i = 0; i < samples.size(); i += step) {
      const Wrench wrench = to_wrench(samples[i]);
      const Eigen::Vector3d& v = torque ? wrench.torque_Nm : wrench.force_N;
      std::fprintf(gnuplot, "%g %g %g %g\n", static_cast<double>(i) / kTrackRate_Hz, v.x(), v.y(),
                   v.z());
    }
    std::fputs("e\n", gnuplot);
  }
}

/// Puts a plot between two heights of a picture, in pixels from its top.
void place(FILE* gnuplot, int top, int bottom, int height) {
  std::fprintf(gnuplot, "set tmargin at screen %g\nset bmargin at screen %g\n",
               1 - static_cast<double>(top) / height, 1 - static_cast<double>(bottom) / height);
}

/// The stills side by side, and a dotted line through the middle of each for the curves that
/// follow.
void draw_stills(FILE* gnuplot, const FilmStills& stills, double length_s) {
  const double part_s = length_s / kStills;
  const double pixel_s = 0.98 * part_s / stills.width;  // with a gap
  std::fputs("set yrange [0:1]\nunset border\nunset tics\nplot ", gnuplot);
  for (int i = 0; i < kStills; ++i) {
    std::fprintf(gnuplot,
                 "%s'-' binary array=(%d,%d) format='%%uchar%%uchar%%uchar' flipy origin=(%g,%g) "
                 "dx=%g dy=%g with rgbimage notitle",
                 i == 0 ? "" : ", ", stills.width, stills.height,
                 i * part_s + 0.01 * part_s + pixel_s / 2, 0.5 / stills.height, pixel_s,
                 1.0 / stills.height);
  }
  std::fputc('\n', gnuplot);
  for (const std::vector<uint8_t>& rgb : stills.rgb) {
    std::fwrite(rgb.data(), 1, rgb.size(), gnuplot);
  }
  std::fputs("\nset yrange [*:*]\nset border\nset tics\n", gnuplot);
  for (int i = 0; i < kStills; ++i) {
    const double t = (i + 0.5) * part_s;
    std::fprintf(gnuplot,
                 "set arrow from first %g, graph 0 to first %g, graph 1 nohead back linecolor rgb "
                 "'#707070' dashtype 3\n",
                 t, t);
  }
}

/// gnuplot reports no error when the disk is full.
bool is_whole_png(int descriptor) {
  constexpr char kEnd[] = "\0\0\0\0IEND\xAE\x42\x60\x82";
  char end[sizeof kEnd - 1] = {};
  const off_t size = lseek(descriptor, 0, SEEK_END);
  return size > static_cast<off_t>(sizeof end) &&
         pread(descriptor, end, sizeof end, size - static_cast<off_t>(sizeof end)) ==
             static_cast<ssize_t>(sizeof end) &&
         std::memcmp(end, kEnd, sizeof end) == 0;
}

void draw(const std::vector<TrackSample>& samples, const FilmStills& stills,
          const std::string& png) {
  PartFile picture(png);
  Gnuplot plot(picture.descriptor());
  FILE* const gnuplot = plot.input();
  const double length_s = static_cast<double>(samples.size()) / kTrackRate_Hz;
  // As high as its width between the margins makes a still.
  const int above = stills.rgb.empty() ? 0 : kStillWidth * stills.height / stills.width + kGap;
  const int height = kCurves + above;
  std::fprintf(gnuplot,
               "set terminal pngcairo size %d,%d font 'sans,12'\n%sset xrange [0:%g]\n"
               "set multiplot\n",
               kWidth, height, kStyle, length_s);
  if (!stills.rgb.empty()) {
    place(gnuplot, kGap, above, height);
    draw_stills(gnuplot, stills, length_s);
  }
  const int middle = above + kCurves / 2;
  place(gnuplot, above + kGap, middle - 2 * kGap, height);
  std::fputs(
      "set ylabel 'force, N'\n"
      "plot '-' using 1:2 title 'x, right', '' using 1:3 title 'y, up', '' using 1:4 title 'z, to "
      "the viewer'\n",
      gnuplot);
  send(gnuplot, samples, false);
  place(gnuplot, middle + kGap, height - 4 * kGap, height);
  std::fputs(
      "set ylabel 'torque, N m'\nset xlabel 'time, s'\n"
      "plot '-' using 1:2 title 'about x', '' using 1:3 title 'about y', '' using 1:4 title 'about "
      "z'\n",
      gnuplot);
  send(gnuplot, samples, true);
  plot.finish();
  if (!is_whole_png(picture.descriptor())) {
    throw std::runtime_error(png + ": cannot be written as a whole; the disk may be full");
  }
  picture.publish();
}

}  // namespace

int plot_track_command(int argc, char** argv) {
  bool help = false;
  std::string film;
  const std::vector<std::string> operands =
      parse_options(argc, argv,
                    {{"film", true, [&](const std::string& text) { film = text; }},
                     {"help", false, [&](const std::string&) { help = true; }}});
  if (help) {
    std::cout << kPlotTrackHelp;
    return kDone;
  }
  if (operands.size() != 2) throw UsageError("TRACK and PNG are needed, and nothing else");
  const std::string ending = std::filesystem::path(operands[1]).extension().string();
  if (!ending.empty() && ending != ".png") {
    throw UsageError(operands[1] + ": the picture is a PNG, and its name ends in .png");
  }
  TrackCondition condition;
  const std::vector<TrackSample> samples = load_track(operands[0], &condition);
  if (samples.empty()) throw std::runtime_error(operands[0] + ": has no samples to draw");
  FilmStills stills;
  if (!film.empty()) {
    stills = film_stills(film, static_cast<int64_t>(samples.size()) * kTrackPeriod_ns,
                         condition.notes, kStills, kStillWidth);
  }
  draw(samples, stills, operands[1]);
  return kDone;
}

}  // namespace spidar
