// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Draws Fig. 6 to 10 of the paper: paper_figures FOLDER
///
/// A bouncing ball is rendered frame by frame, its motion is measured from the pictures as the
/// element does, and both gain controllers turn it into force. Each curve is drawn together with
/// the one that follows from the physics of the scene.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "apps/gnuplot.h"
#include "apps/help.h"
#include "core/analysis/motion_analyzer.h"
#include "core/force/gain_controller.h"
#include "tests/support/ball_scene.h"

namespace fs = std::filesystem;
using spidar::test::BallScene;
using spidar::test::BallSettings;

namespace {

constexpr double kDuration_s = 6;
constexpr int kFrameRate_Hz = 30;
constexpr double kAnalyticStep_s = 0.001;

/// The same height as the reference frame, so that the controllers see the pixels of the figures.
BallSettings scene_settings() {
  BallSettings settings;
  settings.width = 640;
  settings.height = 480;
  settings.start_px = {320, 60};
  settings.floor_px = 460;
  return settings;
}

/// One moment; upwards is positive, as in the paper.
struct Row {
  double time_s = 0;
  double position_px = 0;  ///< above the floor
  double velocity_px_s = 0;
  double acceleration_px_s2 = 0;
};

/// Applies both controllers to a curve, in its order, and writes it together with the forces.
class CurveFile {
 public:
  explicit CurveFile(const fs::path& path) : file_(path) { file_.exceptions(std::ios::failbit); }

  void add(const Row& row) {
    const Eigen::Vector2d velocity_px_s(0, -row.velocity_px_s);  // I: y down
    const double linear_N = render_motion(linear_, velocity_px_s).force_N.y();
    const double nonlinear_N = render_motion(nonlinear_, velocity_px_s).force_N.y();
    file_ << row.time_s << ' ' << row.position_px << ' ' << row.velocity_px_s << ' '
          << row.acceleration_px_s2 << ' ' << linear_.gain_N_s_px() << ' ' << linear_N << ' '
          << nonlinear_N << '\n';
  }
  void close() { file_.close(); }

 private:
  static constexpr spidar::ControllerSettings kSettings{};
  std::ofstream file_;
  spidar::LinearController linear_{kSettings.max_force_N};
  spidar::NonlinearController nonlinear_{kSettings.max_force_N, kSettings.alpha_s_px};
};

double height_px(const BallScene& scene, double time_s) {
  const BallSettings& settings = scene.settings();
  return settings.floor_px - settings.radius_px - scene.position_px(time_s).y();
}

void write_analytic(const BallScene& scene, const fs::path& path) {
  CurveFile curve(path);
  for (int i = 0; i * kAnalyticStep_s <= kDuration_s; ++i) {
    const double time_s = i * kAnalyticStep_s;
    curve.add({time_s, height_px(scene, time_s), -scene.velocity_px_s(time_s).y(),
               -scene.acceleration_px_s2(time_s).y()});
  }
  curve.close();
}

/// Error of the measured displacements, pixels in a frame.
struct StepError {
  double rms_px = 0;
  double largest_px = 0;
};

/// The position is the sum of the measured displacements, starting where the ball starts. A
/// measured velocity is the mean over an interval between frames and belongs to its middle;
/// acceleration is the difference of two velocities.
StepError write_measured(const BallScene& scene, const fs::path& path) {
  const BallSettings& settings = scene.settings();
  std::vector<uint8_t> pixels(static_cast<size_t>(settings.width * settings.height));
  const spidar::ImageView view{pixels.data(), settings.width, settings.height, settings.width};
  spidar::MotionAnalyzer analyzer(spidar::paper_settings());
  CurveFile curve(path);
  Row row;
  row.position_px = height_px(scene, 0);
  row.velocity_px_s = NAN;
  const double interval_s = 1.0 / kFrameRate_Hz;
  StepError error;
  double squares_px2 = 0;
  int steps = 0;
  for (int frame = 0; frame <= kDuration_s * kFrameRate_Hz; ++frame) {
    const double time_s = frame * interval_s;
    scene.render(time_s, pixels.data(), settings.width);
    const auto found = analyzer.analyze(view, std::llround(1e9 * time_s));
    if (found.restarted) continue;
    const double velocity_px_s = -found.motion.velocity_px_s.y();
    const double step_px = velocity_px_s * interval_s;
    const double true_step_px = height_px(scene, time_s) - height_px(scene, time_s - interval_s);
    squares_px2 += (step_px - true_step_px) * (step_px - true_step_px);
    error.largest_px = std::max(error.largest_px, std::fabs(step_px - true_step_px));
    ++steps;
    row.time_s = time_s - interval_s / 2;
    row.position_px += step_px / 2;
    row.acceleration_px_s2 = (velocity_px_s - row.velocity_px_s) / interval_s;
    row.velocity_px_s = velocity_px_s;
    curve.add(row);
    row.position_px += step_px / 2;
  }
  curve.close();
  error.rms_px = std::sqrt(squares_px2 / steps);
  return error;
}

StepError draw(const fs::path& folder) {
  fs::create_directories(folder);
  const BallScene scene(scene_settings());
  const fs::path measured = folder / "measured.dat";
  const fs::path analytic = folder / "analytic.dat";
  const StepError error = write_measured(scene, measured);
  write_analytic(scene, analytic);
  run_gnuplot("paper_figures.gp",
              {{"folder", folder}, {"measured", measured}, {"analytic", analytic}},
              {{"gravity", std::to_string(scene.settings().gravity_px_s2)}});
  fs::remove(measured);
  fs::remove(analytic);
  return error;
}

}  // namespace

int main(int argc, char** argv) {
  constexpr const char* kUsage = "usage: paper_figures FOLDER    fig6.png to fig10.png into it\n";
  if (asks_for_help(argc, argv, kUsage)) return 0;
  if (argc != 2 || argv[1][0] == '-') {
    std::fputs(kUsage, stderr);
    return 2;
  }
  try {
    const StepError error = draw(argv[1]);
    std::printf("drawn: fig6.png to fig10.png in %s\n", argv[1]);
    std::printf("measured motion against the true one: %.4f px a frame rms, %.4f at most\n",
                error.rms_px, error.largest_px);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
