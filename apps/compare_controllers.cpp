// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Compares how the gain controllers would feel: compare_controllers [VIDEO|ANALYSIS.motion ...]
///
/// Measures the motion of a rendered bouncing ball and of each video once, as the element does by
/// default, or takes it from what `spidartrack analyze` has measured, applies each controller to
/// it, and prints a table (Markdown) of what a hand would notice. The figures do not replace asking
/// people.

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <vector>

#include <gst/gst.h>

#include "apps/feel/analyzed_film.h"
#include "apps/feel/figures.h"
#include "apps/feel/video_film.h"
#include "apps/help.h"
#include "tests/support/ball_scene.h"

namespace {

using spidar::ControllerKind;
using spidar::Film;

/// The ball of paper_figures, until it comes to rest.
Film ball_film(const spidar::AnalyzerSettings& settings) {
  constexpr int kFrameRate_Hz = 30;
  constexpr int kDuration_s = 12;
  spidar::test::BallSettings scene_settings;
  scene_settings.height = 480;
  scene_settings.floor_px = 460;
  const spidar::test::BallScene scene(scene_settings);
  const int width = scene_settings.width, height = scene_settings.height;
  std::vector<uint8_t> pixels(static_cast<size_t>(width * height));
  spidar::FilmRecorder recorder("bouncing ball", settings);
  for (int n = 0; n < kDuration_s * kFrameRate_Hz; ++n) {
    const double time_s = static_cast<double>(n) / kFrameRate_Hz;
    scene.render(time_s, pixels.data(), width);
    recorder.add({pixels.data(), width, height, width}, std::llround(1e9 * time_s));
  }
  return recorder.film();
}

void print(const Film& film, const spidar::FilterSettings& filter) {
  struct Named {
    const char* name;
    ControllerKind kind;
  };
  for (const Named& controller :
       {Named{"linear", ControllerKind::kLinear}, Named{"nonlinear", ControllerKind::kNonlinear},
        Named{"adaptive", ControllerKind::kAdaptive}}) {
    spidar::ControllerSettings settings;
    settings.kind = controller.kind;
    const spidar::FeelFigures f = spidar::feel(film, filter, settings);
    std::printf("| %s, moving %.0f %% | `%s` | %.0f | %.1f | %.0f | %.2f | %.3f |\n",
                film.name.c_str(), 100 * f.moving, controller.name, 100 * f.felt, 100 * f.at_limit,
                100 * f.told_apart, f.mean_force_N, f.rank);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (asks_for_help(argc, argv, "usage: compare_controllers [VIDEO|ANALYSIS.motion ...]\n"))
    return 0;
  gst_init(&argc, &argv);
  const spidar::AnalyzerSettings settings;
  std::printf(
      "Of the time in which something moves; 3 N at most.\n\n"
      "| film | controller | felt %% | at the limit %% | steps told apart %% | mean N | "
      "rank correlation |\n|---|---|---|---|---|---|---|\n");
  try {
    print(ball_film(settings), settings.filter);
    for (int i = 1; i < argc; ++i) {
      const auto read = spidar::is_analysis(argv[i]) ? spidar::read_analysis : spidar::read_film;
      print(read(argv[i], settings), settings.filter);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
