// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <array>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <string>

#include "plugin/tools/gnuplot.h"
#include "plugin/tools/spidartrack_commands.h"
#include "plugin/tools/track_samples.h"
#include "spidar/tools/command_line.h"
#include "spidar/whole_file.h"

namespace spidar::tools {
namespace {

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
constexpr int kWidth = 1400, kHeight = 700, kGap = 14;

/// The most bins per curve: more than the picture is wide in pixels.
constexpr size_t kBins = 4000;

/// Writes each bin as two rows, its minimum and its maximum, with the columns time, force and
/// torque. A short peak is therefore visible in a track of any length.
class BinWriter {
 public:
  BinWriter(std::ostream& script, size_t samples)
      : script_(script), step_(samples / kBins + 1), samples_(samples) {}

  void add(const TrackSample& sample) {
    const Eigen::Matrix<double, 6, 1> value = to_wrench(sample).stacked();
    for (size_t axis = 0; axis < kTrackChannels; ++axis) {
      const double now = value[static_cast<Eigen::Index>(axis)];
      low_[axis] = count_ % step_ == 0 ? now : std::min(low_[axis], now);
      high_[axis] = count_ % step_ == 0 ? now : std::max(high_[axis], now);
    }
    if (++count_ % step_ == 0 || count_ == samples_) write_bin();
  }

 private:
  void write_bin() {
    const size_t begin = (count_ - 1) / step_ * step_;
    for (const auto& row : {low_, high_}) {
      script_ << static_cast<double>(begin) / kTrackRate_Hz;
      for (const double value : row) script_ << ' ' << value;
      script_ << '\n';
    }
  }

  std::ostream& script_;
  const size_t step_, samples_;
  size_t count_ = 0;
  std::array<double, kTrackChannels> low_{}, high_{};
};

/// Sets the top and bottom edges of a plot, in pixels from the top of the picture.
void place(std::ostream& script, int top, int bottom) {
  script << "set tmargin at screen " << 1 - static_cast<double>(top) / kHeight
         << "\nset bmargin at screen " << 1 - static_cast<double>(bottom) / kHeight << '\n';
}

}  // namespace

int plot_track(const std::string& track, const std::string& png, bool force) {
  const bool has_ending = std::filesystem::path(png).has_extension();
  if (has_ending && !ends_with(png, ".png")) {
    throw UsageError(png + ": the picture is a PNG, and its name ends in .png");
  }
  note_read(track);
  PartFile picture(png, {force, "spidartrack plot"});
  size_t count = 0;
  expect_own_track(read_track(track, [&count](const TrackSample&) { ++count; }));
  if (count == 0) throw std::runtime_error(track + ": has no samples to draw");
  std::ostringstream script;
  script << "set terminal pngcairo size " << kWidth << ',' << kHeight << " font 'sans,12'\n"
         << kStyle << "set xrange [0:" << static_cast<double>(count) / kTrackRate_Hz << "]\n";
  script << "$samples << END\n";
  BinWriter bins(script, count);
  read_track(track, [&bins](const TrackSample& sample) { bins.add(sample); });
  script << "END\n";
  script << "set multiplot\n";
  place(script, kGap, kHeight / 2 - 2 * kGap);
  // Keep the range from being empty when all values are zero.
  script << "set yrange [*<-0.1 : 0.1<*]\nset ylabel 'force, N'\n"
            "plot $samples using 1:2 title 'x, right', '' using 1:3 title 'y, up', "
            "'' using 1:4 title 'z, towards the viewer'\n";
  place(script, kHeight / 2 + kGap, kHeight - 4 * kGap);
  script << "set yrange [*<-1 : 1<*]\nset ylabel 'torque, mN m'\nset xlabel 'time, s'\n"
            "plot $samples using 1:(1000*$5) title 'about x', '' using 1:(1000*$6) title "
            "'about y', '' using 1:(1000*$7) title 'about z'\n";
  draw_with_gnuplot(script.str(), picture);
  publish(picture);
  return kDone;
}

}  // namespace spidar::tools
