// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Simulates a hand that strokes across a picture, and draws what it feels. examples/touch.sh
/// builds this program. The relief, the 1 kHz loop and the simulated device are those of the
/// element; a still picture needs no playback.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gst/gst.h>

#include "core/touch/depth_picture.h"
#include "core/touch/relief.h"
#include "examples/touch/first_picture.h"
#include "plugin/frame/touch_view.h"
#include "plugin/tools/gnuplot.h"
#include "spidar/devices/sim/simulated_device.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/loop/string_grip.h"
#include "spidar/part_file.h"
#include "spidar/tools/command_line.h"
#include "spidar/whole_file.h"

namespace fs = std::filesystem;
using namespace spidar;

namespace {

/// Draws the data `$relief` and `$ticks`.
constexpr const char* kScript = R"(set terminal pngcairo size 1100,1300 font 'sans,12'
set encoding utf8
set datafile separator ','
set grid linecolor rgb '#d8d8d8' linetype 1 linewidth 0.5
set border 3 linecolor rgb '#606060'
set tics nomirror
set multiplot layout 3,1 title title . ': touched from left to right' noenhanced font ',15' \
    margins 0.09,0.84,0.06,0.95 spacing 0.07
set xlabel 'x, mm'
set ylabel 'y, mm'
set cblabel 'relief, mm'
set palette gray
set autoscale fix
set key off
plot $relief using 1:2:3 skip 1 with image, \
     $ticks using 2:3 skip 1 with lines linewidth 2 linecolor rgb '#d9541e'
set key at graph 1.02, graph 0.95 left top Left reverse noenhanced samplen 2 spacing 1.2
set xlabel 'time, s'
set ylabel 'height, mm'
plot $ticks using 1:5 skip 1 with lines linewidth 2 linecolor rgb '#a0a0a0' title 'surface', \
     $ticks using 1:4 skip 1 with lines linewidth 1.5 linecolor rgb '#d9541e' title 'grip'
set ylabel 'force on the hand, N'
plot $ticks using 1:6 skip 1 with lines linewidth 1.5 linecolor rgb '#0b5fa5' title 'x, right', \
     $ticks using 1:7 skip 1 with lines linewidth 1.5 linecolor rgb '#009e73' title 'y, up', \
     $ticks using 1:8 skip 1 with lines linewidth 1.5 linecolor rgb '#d9541e' title 'z, to viewer'
)";

constexpr int kApproach_ticks = 600;  ///< to the left side, then into the surface
constexpr int kStroke_ticks = 4000;
/// The target of the hand lies behind the middle of the relief: the hand presses with about 1.5 N.
constexpr double kPress_m = 0.008;
constexpr double kStroke = 0.8;  ///< of the picture's width

/// Publishes the picture's relief, as with touch=luma, or that of its depth, as with touch=depth.
void publish(const ImageView& picture, bool is_depth, touch::Mailbox& mailbox) {
  touch::Surface& frame = *mailbox.begin(mailbox.generation());
  touch::ReliefSettings settings;
  settings.floor_z_m = -0.5 * settings.relief_m;
  touch::ReliefBuilder builder;
  if (is_depth) {
    touch::DepthPicture depth;
    if (!depth.read(picture, {true}, 0) ||
        !builder.from_levels(depth.levels(), settings, frame.relief)) {
      throw std::runtime_error("the picture is black: it has no depth");
    }
  } else if (!builder.from_brightness(picture, settings, frame.relief)) {
    throw std::runtime_error("the picture has no pixels");
  }
  frame.has_surface = true;
  frame.contact.friction = 0.3;
  mailbox.publish();
}

/// The target of the hand at a tick: to the side of the picture, in, across, out.
Eigen::Vector3d hand_m(int tick, double half_width_m) {
  const double side_m = kStroke * half_width_m;
  if (tick < kApproach_ticks) return {-side_m, 0, kPress_m};
  const double way = std::min(1.0, static_cast<double>(tick - kApproach_ticks) / kApproach_ticks);
  const int stroking = tick - 2 * kApproach_ticks;
  if (stroking < 0) return {-side_m, 0, kPress_m * (1 - 2 * way)};
  const double across = std::min(1.0, static_cast<double>(stroking) / kStroke_ticks);
  return {side_m * (2 * across - 1), 0, -kPress_m};
}

std::string relief_csv(const touch::HeightField& relief) {
  std::ostringstream out;
  out << "x_mm,y_mm,z_mm\n";
  constexpr int kEvery = 2;
  for (int y = 0; y < touch::HeightField::kRows; y += kEvery) {
    for (int x = 0; x < touch::HeightField::kColumns; x += kEvery) {
      out << 1e3 * relief.x_m(x) << ',' << 1e3 * relief.y_m(y) << ','
          << 1e3 * static_cast<double>(relief.row(y)[x]) << '\n';
    }
    out << '\n';
  }
  return out.str();
}

/// Only files of this program are replaced.
const PartFile::Replaces kOwn{true, "touch.sh", false};

void save(const std::string& csv, const fs::path& path) {
  PartFile file(path, kOwn);
  file.write(csv);
  file.publish();
}

struct Felt {
  int touching = 0;
  double deepest_m = 0;
  double largest_N = 0;
  std::string csv;  ///< a line for each tick
};

Felt stroke(touch::Mailbox& mailbox, const Profile& profile, double half_width_m) {
  std::ostringstream out;
  out << "time_s,grip_x_mm,grip_y_mm,grip_z_mm,surface_z_mm,force_x_N,force_y_N,force_z_N\n";
  SimulatedDevice device(profile, SimulatedDevice::Time::kFixedStep);
  const auto loop = std::make_unique<HapticLoop>(std::make_unique<StringGrip>(profile, device));
  loop->connect_touch(&mailbox);
  loop->open();
  int64_t now_ns = kTick_ns;
  loop->set_playback_clock({now_ns, 0, 1.0, true});
  const touch::HeightField& relief = mailbox.front()->relief;
  Felt felt;
  for (int tick = 0; tick < 2 * kApproach_ticks + kStroke_ticks; ++tick) {
    Pose hand;
    hand.position_m = hand_m(tick, half_width_m);
    device.set_hand(hand);
    now_ns += kTick_ns;
    loop->tick(now_ns, now_ns);
    const FeltState now = device.felt();
    const touch::Contact& contact = loop->snapshot().last.contact;
    felt.touching += contact.touching;
    felt.deepest_m = std::max(felt.deepest_m, contact.depth_m);
    felt.largest_N = std::max(felt.largest_N, now.wrench.force_N.norm());
    if (tick < kApproach_ticks) continue;
    const Eigen::Vector3d& at_m = now.pose.position_m;
    const Eigen::Vector3d& force_N = now.wrench.force_N;
    out << 1e-3 * (tick - kApproach_ticks) << ',' << 1e3 * at_m.x() << ',' << 1e3 * at_m.y() << ','
        << 1e3 * at_m.z() << ',' << 1e3 * relief.at(at_m.x(), at_m.y()).z_m << ',' << force_N.x()
        << ',' << force_N.y() << ',' << force_N.z() << '\n';
  }
  felt.csv = out.str();
  return felt;
}

void write_touch(const std::string& image, bool is_depth, const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw std::runtime_error("--output " + folder.string() + ": " + error.message());
  note_read(image);
  const GreyPicture picture = first_picture(image);

  const Profile profile = load_profile(kDefaultProfile);
  const Eigen::Vector2d half_m = GripPointer(profile.geometry).half_size_m();
  touch::Mailbox mailbox(2 * half_m.x(), 2 * half_m.y(), touch::Mailbox::kMinSlots);
  publish(picture.view(), is_depth, mailbox);
  const fs::path png = folder / "touch.png";
  const std::string relief = relief_csv(mailbox.front()->relief);
  save(relief, folder / "touch-relief.csv");
  const Felt felt = stroke(mailbox, profile, half_m.x());
  save(felt.csv, folder / "touch-ticks.csv");
  std::printf("picture:            %.0f mm x %.0f mm in the hand's space\n", 2e3 * half_m.x(),
              2e3 * half_m.y());
  std::printf("in contact:         %.2f s of %.2f s\n", 1e-3 * felt.touching,
              1e-3 * (kApproach_ticks + kStroke_ticks));
  std::printf("deepest:            %.1f mm below the surface\n", 1e3 * felt.deepest_m);
  std::printf("largest force:      %.2f N\n", felt.largest_N);
  PartFile drawing(png, kOwn);
  tools::draw_with_gnuplot("title = " + tools::gnuplot_string(fs::path(image).filename()) +
                               "\n$relief << END\n" + relief + "END\n$ticks << END\n" + felt.csv +
                               "END\n" + kScript,
                           drawing);
  drawing.publish();
  std::printf("drawn:              %s\n", png.c_str());
}

}  // namespace

int main(int argc, char** argv) {
  constexpr int kMistake = 2;  // in the command line
  std::string image, folder = ".";
  bool is_depth = false;
  CLI::App app("Simulates a hand that strokes across a picture, and draws what it feels.", "touch");
  app.add_option("IMAGE", image, "A picture or a film, of which the first frame is touched")
      ->required();
  app.add_flag("--depth", is_depth,
               "IMAGE is an image of depth of 8 bits: bright is near, black is not known");
  app.add_option(
      "--output", folder,
      "Where touch.png, touch-relief.csv and touch-ticks.csv go, else the current folder");
  spidar::tools::mark_files(argc, argv);
  try {
    app.parse(argc, argv);
    gst_init(nullptr, nullptr);
    write_touch(image, is_depth, folder);
    return spidar::tools::status_after_printing("touch", 0);
  } catch (const CLI::ParseError& error) {
    return spidar::tools::status_after_printing("touch", app.exit(error) == 0 ? 0 : kMistake);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "touch: %s\n", error.what());
    return 1;
  }
}
