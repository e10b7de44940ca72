// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "examples/play/picture.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <vector>

#include "core/force/motion_rendering.h"
#include "plugin/tools/gnuplot.h"

namespace {

constexpr const char* kStyle = R"(set encoding utf8
set linetype 1 linecolor rgb '#0b5fa5' linewidth 1.5
set linetype 2 linecolor rgb '#d9541e' linewidth 1.5
set linetype 3 linecolor rgb '#009e73' linewidth 1.5
set linetype 4 linecolor rgb '#7b3294' linewidth 1.5
set style data lines
set grid linecolor rgb '#d8d8d8' linetype 1 linewidth 0.5
set key at graph 1.02, graph 0.95 left top Left reverse noenhanced samplen 2 spacing 1.2
set border 3 linecolor rgb '#606060'
set tics nomirror
set format x ''
set lmargin at screen 0.11
set rmargin at screen 0.84
)";

/// One colour for each string, from Okabe and Ito's set for colour-blind readers.
constexpr const char* kStringColours[] = {"#e69f00", "#56b4e9", "#009e73", "#999933",
                                          "#0072b2", "#d55e00", "#cc79a7", "#000000"};

/// The columns of a force or a torque, and how they are shown.
struct Force {
  const char* label;
  int line;
  int frame_column, device_column;
  double unit;   ///< of the axis, per unit of the columns
  double per_N;  ///< in the unit of the columns, what corresponds to 1 N
};

constexpr Force kForces[] = {
    {"force x, N\\n(right)", 1, 6, 2, 1, 1},
    {"force y, N\\n(up)", 2, 7, 3, 1, 1},
    {"force z, N\\n(towards the viewer)", 3, 8, 4, 1, 1},
    {"torque, mN m\\n(about z)", 4, 9, 5, 1e3, spidar::kTorqueArm_m},
};

/// The blank lines at the beginning of a scene interrupt the curves. The position is the sum of the
/// motion in a scene, so it begins again at zero there.
void write_frames(std::ostream& script, const Record& record) {
  script << "$frames << END\n";
  double x_px = 0, y_px = 0, last_s = 0;
  for (const FrameRow& frame : record.frames()) {
    const double interval_s = frame.begins_scene ? 0 : frame.time_s - last_s;
    if (frame.begins_scene) {
      x_px = y_px = 0;
      script << '\n';
    }
    x_px += frame.velocity_px_s[0] * interval_s;
    y_px += frame.velocity_px_s[1] * interval_s;
    last_s = frame.time_s;
    script << frame.time_s << ' ' << x_px << ' ' << y_px;
    for (const double speed_px_s : frame.velocity_px_s) {
      script << ' ' << (frame.begins_scene ? NAN : speed_px_s);  // there was no comparison
    }
    for (const double force_N : frame.force_N) script << ' ' << force_N;
    script << ' ' << frame.torque_Nm << '\n';
  }
  script << "END\n";
}

void write_devices(std::ostream& script, const Record& record) {
  script << "$devices << END\n";
  for (const DeviceRow& row : record.devices()) {
    script << row.time_s;
    for (const double force_N : row.force_N) script << ' ' << force_N;
    script << ' ' << row.torque_Nm;
    for (const double tension_N : row.tension_N) script << ' ' << tension_N;
    script << '\n';
  }
  script << "END\n";
}

/// The words of the reasons in the order in which they first occur.
std::vector<std::string> reasons_of(const Record& record) {
  std::vector<std::string> words;
  for (const auto& [time_s, word] : record.reasons()) {
    const bool is_new = std::find(words.begin(), words.end(), word) == words.end();
    if (word != kFelt && is_new) words.push_back(word);
  }
  return words;
}

/// Spans of time in which nothing was felt, a row of the panel for each reason.
void write_reasons(std::ostream& script, const Record& record,
                   const std::vector<std::string>& words) {
  const auto& reasons = record.reasons();
  script << "$reasons << END\n";
  for (size_t i = 0; i < reasons.size();) {
    const auto& [begin_s, reason] = reasons[i];
    size_t end = i + 1;
    while (end < reasons.size() && reasons[end].second == reason) ++end;
    const auto word = std::find(words.begin(), words.end(), reason);
    const double end_s = reasons[std::min(end, reasons.size() - 1)].first;
    if (word != words.end()) {
      script << begin_s << ' ' << word - words.begin() << ' ' << end_s - begin_s << '\n';
    }
    i = end;
  }
  script << "END\n";
}

void draw_position(std::ostream& script) {
  script << "set yrange [*<-1 : 1<*]\n"  // not empty if nothing moves
            "set ylabel \"position, px\\n(moved in the scene)\"\n"
            "plot $frames using 1:2 title 'x, right', $frames using 1:3 title 'y, up'\n";
}

/// Draws a line at zero as well, because gnuplot draws no picture without a point, for example for
/// a single frame.
void draw_velocity(std::ostream& script) {
  script << "set ylabel 'velocity, px/s'\n"
            "plot 0 linecolor rgb '#d8d8d8' linewidth 0.5 notitle, $frames using 1:4 linetype 1 "
            "title 'x, right', $frames using 1:5 linetype 2 title 'y, up'\n";
}

void draw_reasons(std::ostream& script, const std::vector<std::string>& words) {
  script << "unset ylabel\nset label 1 'not felt because' at graph 1.02, graph 0.5\nset yrange ["
         << static_cast<double>(words.size()) - 0.5 << ":-0.5]\nset ytics (";
  for (size_t i = 0; i < words.size(); ++i) {
    script << (i == 0 ? "" : ", ") << spidar::tools::gnuplot_string(words[i]) << ' ' << i;
  }
  script << ") font ',9'\nplot $reasons using 1:2:3:(0) with vectors nohead linewidth 7 linecolor "
            "rgb '#808080' notitle\nset ytics auto font ',12'\nunset label 1\n";
}

/// Whether a hand could feel the wanted or delivered value in any row.
template <typename Value>
bool is_felt(const Record& record, double least, const Value& value) {
  const auto reaches = [&](const auto& row) { return std::abs(value(row)) >= least; };
  return std::any_of(record.frames().begin(), record.frames().end(), reaches) ||
         std::any_of(record.devices().begin(), record.devices().end(), reaches);
}

/// The number of strings that pull.
size_t strings_of(const Record& record) {
  size_t strings = 0;
  for (const DeviceRow& row : record.devices()) {
    for (size_t i = strings; i < row.tension_N.size(); ++i) {
      if (row.tension_N[i] > 0) strings = i + 1;
    }
  }
  return strings;
}

void draw_tensions(std::ostream& script, size_t strings) {
  script << "set ylabel 'string tension, N'\nset yrange [0:0.1<*]\nplot ";
  for (size_t i = 0; i < strings; ++i) {
    script << (i == 0 ? "" : ", ") << "$devices using 1:" << 6 + i
           << " linewidth 1.2 linecolor rgb '" << kStringColours[i % 8] << "' title 'string " << i
           << "'";
  }
  script << '\n';
}

void draw_force(std::ostream& script, const Force& force, double limit_N, bool has_device) {
  const double end = limit_N * force.per_N * force.unit;
  const double band = spidar::kFeltForce_N * force.per_N * force.unit;
  script << "set ylabel \"" << force.label << "\"\nset yrange [" << -end << ':' << end
         << "]\nset object 1 rectangle from graph 0, first " << -band << " to graph 1, first "
         << band << " behind fillcolor rgb '#ececec' fillstyle solid noborder\n"
         << "plot $frames using 1:(" << force.unit << "*$" << force.frame_column << ')';
  if (has_device) {
    script << " with points pointtype 7 pointsize 0.5 linecolor rgb '#a0a0a0' title 'wanted', "
              "$devices using 1:("
           << force.unit << "*$" << force.device_column << ") linetype " << force.line
           << " title 'at the grip'";
  } else {
    script << " linetype " << force.line << " title 'wanted'";
  }
  script << ", NaN with boxes fillstyle solid linecolor rgb '#ececec' title 'too weak to feel'\n"
            "unset object 1\n";
}

constexpr int kWidth_px = 1400, kAbove_px = 70, kBelow_px = 70, kGap_px = 42, kCurve_px = 220,
              kReason_px = 24;

struct Panel {
  int height_px;
  std::function<void(std::ostream&)> draw;
};

int height_of(const std::vector<Panel>& panels) {
  int height_px = kAbove_px + kBelow_px - kGap_px;
  for (const Panel& panel : panels) height_px += panel.height_px + kGap_px;
  return height_px;
}

}  // namespace

std::string picture_script(const Record& record, double max_force_N, const std::string& title) {
  const bool has_device = !record.devices().empty();
  const size_t strings = strings_of(record);
  const std::vector<std::string> reasons = reasons_of(record);
  // A haptic track contains no positions and speeds, and at rest there are none.
  const bool has_motion =
      std::any_of(record.frames().begin(), record.frames().end(), [](const FrameRow& frame) {
        return std::hypot(frame.velocity_px_s[0], frame.velocity_px_s[1]) > 0;
      });
  std::vector<Force> forces;
  const auto in_plane = [](const auto& row) { return std::hypot(row.force_N[0], row.force_N[1]); };
  // When nothing is felt, only the reasons are shown.
  if (reasons.empty() || is_felt(record, spidar::kFeltForce_N, in_plane)) {
    forces = {kForces[0], kForces[1]};
  }
  const auto depth = [](const auto& row) { return row.force_N[2]; };
  const auto roll = [](const auto& row) { return row.torque_Nm; };
  if (is_felt(record, spidar::kFeltForce_N, depth)) forces.push_back(kForces[2]);
  if (is_felt(record, spidar::kFeltForce_N * spidar::kTorqueArm_m, roll)) {
    forces.push_back(kForces[3]);
  }

  std::vector<Panel> panels;
  if (has_motion) {
    panels.push_back({kCurve_px, draw_position});
    panels.push_back({kCurve_px, draw_velocity});
  }
  for (const Force& force : forces) {
    panels.push_back({kCurve_px, [&, force](std::ostream& script) {
                        draw_force(script, force, max_force_N > 0 ? max_force_N : 0.1, has_device);
                      }});
  }
  if (!reasons.empty()) {
    panels.push_back({kReason_px * static_cast<int>(reasons.size() + 1),
                      [&](std::ostream& script) { draw_reasons(script, reasons); }});
  }
  if (strings > 0) {
    panels.push_back({kCurve_px, [&](std::ostream& script) { draw_tensions(script, strings); }});
  }

  const auto [begin_s, end_s] = record.span_s();
  const int height_px = height_of(panels);
  std::ostringstream script;
  script << "set terminal pngcairo size " << kWidth_px << ',' << height_px
         << " font 'DejaVu Sans,12'\n"
         << kStyle << "set xrange [" << begin_s << ':' << std::max(end_s, begin_s + 1) << "]\n";
  write_frames(script, record);
  write_devices(script, record);
  write_reasons(script, record, reasons);
  script << "set multiplot title "
         << spidar::tools::gnuplot_string(title + ": motion felt at the grip")
         << " noenhanced font ',15'\n";
  int top_px = kAbove_px;
  for (size_t i = 0; i < panels.size(); ++i) {
    const auto at_screen = [&](int px) { return 1 - static_cast<double>(px) / height_px; };
    script << "set tmargin at screen " << at_screen(top_px) << "\nset bmargin at screen "
           << at_screen(top_px + panels[i].height_px) << '\n';
    top_px += panels[i].height_px + kGap_px;
    // Only the last panel has times at its axis.
    if (i + 1 == panels.size()) script << "set format x '%g'\nset xlabel 'running time, s'\n";
    panels[i].draw(script);
  }
  return script.str();
}
