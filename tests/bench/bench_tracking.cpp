// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Speed and error of trackers on films of known motion; the columns:
//   ms      time of a frame on one thread: tracks, and the object by motion=object
//   EPE     distance between the measured and the true end of a track, px of the frame
//   lost    points looked for and not found; wrong: tracks more than 1 px off
//   A       error of the mean of all tracks (eq. 10), px a frame
//   B       error of the dominant object's motion against the background, px a frame
//   missed  frames without B; ghosts: frames with an object in films that have none
// "naive" is a first attempt with OpenCV: 200 new points and full size on each frame. "motion=mean"
// uses the same functions with care. B of all pipelines comes from the same search for objects.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <opencv2/core/utility.hpp>

#include "tests/bench/benchmarks.h"
#include "tests/bench/tracking/film_frames.h"
#include "tests/bench/tracking/report.h"
#include "tests/bench/tracking/run.h"
#include "tests/support/motion_cases.h"

namespace {

using namespace spidar;
using namespace spidar::bench;
using test::CaseGroup;
using test::MotionCase;

/// Sizes say nothing new about these, pictures do.
constexpr int kHardWidth = 1280;
constexpr int kHardHeight = 720;
constexpr int kHardScenes = 4;

class Benchmark {
 public:
  void run(const std::vector<std::pair<int, int>>& sizes) {
    for (const auto& [width, height] : sizes) {
      std::vector<Score> sum(pipelines().size());
      for (const auto& [name, each] : score(width, height, CaseGroup::kUsual)) {
        for (size_t k = 0; k < sum.size(); ++k) sum[k].add(each[k]);
      }
      print_usual(std::to_string(width) + "x" + std::to_string(height), pipelines(), sum);
    }
    print_hard(pipelines(), score(kHardWidth, kHardHeight, CaseGroup::kHard));
    print_silent(pipelines(), score(kHardWidth, kHardHeight, CaseGroup::kSilent));
  }

 private:
  std::deque<Runner> runners() const {
    std::deque<Runner> all;
    for (const Pipeline& pipeline : pipelines()) all.emplace_back(pipeline);
    return all;
  }

  /// Cases of a group at one size; those that cannot be made are named and left out.
  CaseScores score(int width, int height, CaseGroup group) {
    CaseScores scores;
    for (const MotionCase& each : test::motion_cases()) {
      if (each.group == group)
        scores.emplace_back(each.name, std::vector<Score>(pipelines().size()));
    }
    std::deque<Runner> all = runners();
    const int scenes = group == CaseGroup::kUsual ? 1 : kHardScenes;
    for (int scene = 1; scene <= scenes; ++scene) {
      for (auto& [name, sums] : scores) {
        const MotionCase& each = test::motion_case(name);
        test::Film film = each.film(width, height, static_cast<uint32_t>(scene));
        std::vector<test::Picture> frames = draw_all(film, test::kFilmFrames);
        try {
          if (each.coded) frames = coded(frames);
        } catch (const std::runtime_error& error) {
          std::printf("%s is left out: %s\n", name.c_str(), error.what());
          continue;
        }
        const std::vector<Score> found = run_all(all, film, frames);
        for (size_t k = 0; k < found.size(); ++k) sums[k].add(found[k]);
      }
    }
    return scores;
  }
};

/// "640x360".
std::pair<int, int> size_of(const std::string& text) {
  int width = 0, height = 0;
  if (std::sscanf(text.c_str(), "%dx%d", &width, &height) != 2 || width < 64 || height < 64) {
    throw std::invalid_argument(text + " is not a size such as 640x360");
  }
  return {width, height};
}

}  // namespace

int spidar::bench::tracking(int argc, char** argv) {
  cv::setNumThreads(1);
  std::vector<std::pair<int, int>> sizes;
  for (int i = 1; i < argc; ++i) sizes.push_back(size_of(argv[i]));
  if (sizes.empty()) sizes = {{640, 360}, {1280, 720}};
  Benchmark().run(sizes);
  return 0;
}
