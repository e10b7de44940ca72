// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Simulates a hand that strokes across a picture, and draws what it feels. examples/touch.sh
/// builds it. The relief, the 1 kHz loop and the simulated device are those of the element;
/// playback is left out, because a still picture needs none.
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <gst/gst.h>

#include "apps/gnuplot.h"
#include "apps/track/luma_reader.h"
#include "core/touch/depth_picture.h"
#include "core/touch/relief.h"
#include "plugin/frame/grip_pointer.h"
#include "spidar/grip/string_grip.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/simulation/simulated_device.h"

namespace fs = std::filesystem;
using namespace spidar;

namespace {

constexpr const char* kUsage =
    "usage: touch IMAGE [--depth] [--output FOLDER]\n"
    "  IMAGE            a picture or a film, of which the first frame is touched\n"
    "  --depth          IMAGE is an image of depth of 8 bits: bright is near, black is not known\n"
    "  --output FOLDER  where touch.png, touch-relief.csv and touch-ticks.csv go; else the current "
    "folder\n";

constexpr int kApproach_ticks = 600;  ///< to the left side, then into the surface
constexpr int kStroke_ticks = 4000;
/// Target position of the hand behind the middle of the relief: it presses with about 1.5 N.
constexpr double kPress_m = 0.008;
constexpr double kStroke = 0.8;  ///< of the picture's width

/// The picture's relief, as touch=luma makes it, or that of its depth, as touch=depth does.
void publish(const ImageView& picture, bool is_depth, TouchMailbox& mailbox) {
  TouchFrame& frame = *mailbox.begin(mailbox.generation());
  ReliefSettings settings;
  settings.floor_z_m = -0.5 * settings.relief_m;
  ReliefBuilder builder;
  if (is_depth) {
    DepthPicture depth;
    const DepthView view{picture.data, picture.width, picture.height, picture.stride_bytes};
    if (!depth.read(view, {true}, 0) ||
        !builder.from_levels(depth.levels(), settings, frame.relief)) {
      throw std::runtime_error("the picture is black: it has no depth");
    }
  } else if (!builder.from_brightness(picture, settings, frame.relief)) {
    throw std::runtime_error("the picture has no pixels");
  }
  frame.has_surface = true;
  frame.contact.friction = {0.3, 0.24};
  mailbox.publish();
}

/// Target of the hand at a tick: to the side of the picture, in, across, out.
Eigen::Vector3d hand_m(int tick, double half_width_m) {
  const double side_m = kStroke * half_width_m;
  if (tick < kApproach_ticks) return {-side_m, 0, kPress_m};
  const double way = std::min(1.0, static_cast<double>(tick - kApproach_ticks) / kApproach_ticks);
  const int stroking = tick - 2 * kApproach_ticks;
  if (stroking < 0) return {-side_m, 0, kPress_m * (1 - 2 * way)};
  const double across = std::min(1.0, static_cast<double>(stroking) / kStroke_ticks);
  return {side_m * (2 * across - 1), 0, -kPress_m};
}

void write_relief(const HeightField& relief, const fs::path& path) {
  std::ofstream out(path);
  out << "x_mm,y_mm,z_mm\n";
  constexpr int kEvery = 2;
  for (int y = 0; y < HeightField::kRows; y += kEvery) {
    for (int x = 0; x < HeightField::kColumns; x += kEvery) {
      out << 1e3 * relief.x_m(x) << ',' << 1e3 * relief.y_m(y) << ','
          << 1e3 * static_cast<double>(relief.row(y)[x]) << '\n';
    }
    out << '\n';
  }
  if (!out.flush()) throw std::runtime_error(path.string() + ": cannot be written");
}

struct Felt {
  int touching = 0;
  double deepest_m = 0;
  double largest_N = 0;
};

Felt stroke(TouchMailbox& mailbox, const Profile& profile, double half_width_m,
            const fs::path& path) {
  std::ofstream out(path);
  out << "time_s,grip_x_mm,grip_y_mm,grip_z_mm,surface_z_mm,force_x_N,force_y_N,force_z_N\n";
  SimulatedDevice device(profile, SimulatedDevice::Time::kFixedStep);
  const auto loop = std::make_unique<HapticLoop>(std::make_unique<StringGrip>(profile, device));
  loop->connect_touch(&mailbox);
  loop->open();
  int64_t now_ns = kTick_ns;
  loop->set_playback_clock({now_ns, 0, 1.0, true});
  const HeightField& relief = mailbox.front()->relief;
  Felt felt;
  for (int tick = 0; tick < 2 * kApproach_ticks + kStroke_ticks; ++tick) {
    Pose hand;
    hand.position_m = hand_m(tick, half_width_m);
    device.set_hand(hand);
    now_ns += kTick_ns;
    loop->tick(now_ns, now_ns);
    const FeltState now = device.felt();
    const Contact& contact = loop->snapshot().last.contact;
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
  if (!out.flush()) throw std::runtime_error(path.string() + ": cannot be written");
  return felt;
}

void touch(const std::string& image, bool is_depth, const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw std::runtime_error("--output " + folder.string() + ": " + error.message());
  LumaReader reader(image);
  LumaReader::Frame frame;
  if (!reader.next(frame)) throw std::runtime_error(image + ": there is no picture in it");

  const Profile profile = load_profile(kDefaultProfile);
  const Eigen::Vector2d half_m = GripPointer(profile.geometry).half_size_m();
  TouchMailbox mailbox(2 * half_m.x(), 2 * half_m.y(), TouchMailbox::kLeastSlots);
  publish(frame.luma, is_depth, mailbox);
  const fs::path relief = folder / "touch-relief.csv";
  const fs::path ticks = folder / "touch-ticks.csv";
  const fs::path png = folder / "touch.png";
  write_relief(mailbox.front()->relief, relief);
  const Felt felt = stroke(mailbox, profile, half_m.x(), ticks);
  std::printf("picture:            %.0f mm x %.0f mm in the hand's space\n", 2e3 * half_m.x(),
              2e3 * half_m.y());
  std::printf("in contact:         %.2f s of %.2f s\n", 1e-3 * felt.touching,
              1e-3 * (kApproach_ticks + kStroke_ticks));
  std::printf("deepest:            %.1f mm below the surface\n", 1e3 * felt.deepest_m);
  std::printf("largest force:      %.2f N\n", felt.largest_N);
  run_gnuplot("touch.gp",
              {{"relief", relief.string()}, {"ticks", ticks.string()}, {"png", png.string()}},
              {{"title", fs::path(image).filename().string()}});
  std::printf("drawn:              %s\n", png.c_str());
}

}  // namespace

int main(int argc, char** argv) {
  std::string image;
  bool is_depth = false;
  fs::path folder = ".";
  for (int k = 1; k < argc; ++k) {
    const std::string argument = argv[k];
    if (argument == "--help" || argument == "-h") {
      std::fputs(kUsage, stdout);
      return 0;
    }
    if (argument == "--depth") {
      is_depth = true;
    } else if (argument == "--output" && k + 1 < argc) {
      folder = argv[++k];
    } else if (image.empty() && argument[0] != '-') {
      image = argument;
    } else {
      std::fprintf(stderr, "touch: %s is unknown, incomplete or one too many\n%s", argument.c_str(),
                   kUsage);
      return 2;
    }
  }
  if (image.empty()) {
    std::fprintf(stderr, "touch: no picture is named\n%s", kUsage);
    return 2;
  }
  gst_init(nullptr, nullptr);
  try {
    touch(image, is_depth, folder);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "touch: %s\n", error.what());
    return 1;
  }
  return 0;
}
