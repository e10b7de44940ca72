// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Prints in what share of the pictures camera and felt motion are right, in films in which little
/// shows how the camera moves, by scene and coding, and in what share something is felt in scenes
/// with depth in which only the camera moves:
///   spidar-bench camera [TEXT]    those whose name contains it
/// Needs ffmpeg. Takes minutes.
#include <cstdio>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/bench/benchmarks.h"
#include "tests/support/coded_film_score.h"
#include "tests/support/depth_clip_score.h"

namespace {

using spidar::test::CodedFilm;
using Wall = CodedFilm::Wall;

struct Scene {
  std::string name;
  CodedFilm film;
};

CodedFilm film(Wall wall, int side_px, double radius_px, double speed_px, int pan_px,
               double noise_grey) {
  CodedFilm film;
  film.wall = wall;
  film.side_px = side_px;
  film.radius_px = radius_px;
  film.speed_px = speed_px;
  film.pan_px << pan_px, 0;
  film.noise_grey = noise_grey;
  return film;
}

std::vector<Scene> scenes() {
  std::vector<Scene> scenes{
      {"rests, square of 64 px", film(Wall::kPlain, 64, 64, 6, 0, 3)},
      {"rests, 128 px", film(Wall::kPlain, 128, 64, 8, 0, 3)},
      {"rests, 128 px, more noise", film(Wall::kPlain, 128, 64, 8, 0, 7)},
      {"rests, 200 px", film(Wall::kPlain, 200, 40, 8, 0, 3)},
      {"rests, a slope, 200 px", film(Wall::kSlope, 200, 40, 8, 0, 3)},
      {"rests, shade, 128 px", film(Wall::kShade, 128, 64, 8, 0, 0)},
      {"rests, face of 246 px", film(Wall::kPlain, 246, 30, 4, 0, 2.5)},
  };
  for (const auto& [name, wall] : {std::pair{"shade", Wall::kShade},
                                   {"faint", Wall::kFaint},
                                   {"ice", Wall::kIce},
                                   {"blur", Wall::kBlur},
                                   {"dark", Wall::kDark},
                                   {"meadow below sky", Wall::kMeadow}}) {
    const auto add = [&](const char* what, const CodedFilm& film) {
      scenes.push_back({std::string("pans, ") + name + what, film});
    };
    add(", square of 64 px", film(wall, 64, 50, 5, 3, 2));
    add(", nothing else", film(wall, 0, 1, 0, -5, 3));
    add(", face of 246 px", film(wall, 246, 20, 3, -4, 2.5));
  }
  return scenes;
}

}  // namespace

int spidar::bench::camera(int argc, char** argv) {
  const std::vector<const test::Coding*> codings{&test::kX264, &test::kX265, &test::kX265Medium,
                                                 &test::kSvtAv1, &test::kSvtAv1Medium};
  std::printf("Share of the pictures in which the camera / what is felt is right, %%:\n\n| |");
  for (const test::Coding* coding : codings) std::printf(" %s |", coding->name);
  std::printf("\n|---|---|---|---|---|---|\n");
  for (Scene& scene : scenes()) {
    if (argc > 1 && scene.name.find(argv[1]) == std::string::npos) continue;
    std::printf("| %s |", scene.name.c_str());
    for (const test::Coding* coding : codings) {
      scene.film.coding = coding->options;
      const std::vector<test::Picture> pictures = scene.film.pictures();
      if (pictures.empty()) throw std::runtime_error("no ffmpeg that codes " + scene.film.coding);
      const test::CodedFilmScore right = test::score(scene.film, pictures);
      std::printf(" %d / %d |", 100 * right.camera / right.pictures,
                  100 * right.felt / right.pictures);
      std::fflush(stdout);
    }
    std::printf("\n");
  }
  std::printf("\nShare of the pictures in which something is felt, %%:\n\n| | |\n|---|---|\n");
  for (int kind = 0; kind < test::DepthClip::kKinds; ++kind) {
    const auto each = static_cast<test::DepthClip::Kind>(kind);
    const std::string name = test::DepthClip::to_string(each);
    if (argc > 1 && name.find(argv[1]) == std::string::npos) continue;
    const test::DepthClipScore sum = test::score(each, test::kDepthClips);
    std::printf("| %s | %.1f |\n", name.c_str(), 100.0 * sum.felt / sum.pictures);
  }
  return 0;
}
