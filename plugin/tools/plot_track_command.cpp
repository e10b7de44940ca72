// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <cstdio>
#include <iostream>
#include <stdexcept>

#include "plugin/tools/spidartrack_commands.h"
#include "plugin/tools/track_samples.h"
#include "spidar/tools/command_line.h"
#include "spidar/tools/exit_status.h"

namespace spidar {
namespace {

constexpr const char* kHelp = R"(usage: spidartrack plot TRACK PNG

Draws force and torque over time. Needs gnuplot.
)";

constexpr const char* kLayout = R"(set terminal pngcairo size 1400,700 font 'sans,12'
set encoding utf8
set style data lines
set grid linecolor rgb '#d8d8d8' linetype 1 linewidth 0.5
set linetype 1 linecolor rgb '#0b5fa5' linewidth 1.5
set linetype 2 linecolor rgb '#d9541e' linewidth 1.5
set linetype 3 linecolor rgb '#009e73' linewidth 1.5
set multiplot layout 2,1
set ylabel 'force, N'
plot '-' using 1:2 title 'x, right', '' using 1:3 title 'y, up', '' using 1:4 title 'z, to the viewer'
)";

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

}  // namespace

int plot_track_command(int argc, char** argv) {
  bool help = false;
  const std::vector<std::string> operands =
      parse_options(argc, argv, {{"help", false, [&](const std::string&) { help = true; }}});
  if (help) {
    std::cout << kHelp;
    return kDone;
  }
  if (operands.size() != 2) throw UsageError("TRACK and PNG are needed, and nothing else");
  if (operands[1].find('\'') != std::string::npos) {
    throw UsageError(operands[1] + ": gnuplot takes no name with an apostrophe");
  }
  const std::vector<TrackSample> samples = load_track(operands[0]);
  FILE* gnuplot = popen("gnuplot", "w");
  if (!gnuplot) throw std::runtime_error("gnuplot cannot be started");
  std::fprintf(gnuplot, "set output '%s'\n%s", operands[1].c_str(), kLayout);
  send(gnuplot, samples, false);
  std::fputs(
      "set ylabel 'torque, N m'\nset xlabel 'time, s'\n"
      "plot '-' using 1:2 title 'about x', '' using 1:3 title 'about y', '' using 1:4 title 'about "
      "z'\n",
      gnuplot);
  send(gnuplot, samples, true);
  if (pclose(gnuplot) != 0) throw std::runtime_error("gnuplot is missing, or cannot draw this");
  return kDone;
}

}  // namespace spidar
