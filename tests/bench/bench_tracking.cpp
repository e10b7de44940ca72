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
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gst/gst.h>
#include <opencv2/core/utility.hpp>

#include "tests/bench/tracking/film_frames.h"
#include "tests/bench/tracking/middlebury.h"
#include "tests/bench/tracking/options.h"
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

std::vector<Pipeline> chosen_pipelines(const std::vector<std::string>& names) {
  if (names.empty()) return pipelines();
  std::vector<Pipeline> chosen;
  for (const std::string& name : names) {
    const auto found = std::find_if(pipelines().begin(), pipelines().end(),
                                    [&](const Pipeline& p) { return p.name == name; });
    if (found == pipelines().end()) {
      throw std::invalid_argument("no pipeline '" + name + "'; --list names those there are");
    }
    chosen.push_back(*found);
  }
  return chosen;
}

std::vector<const MotionCase*> chosen_cases(const std::vector<std::string>& names) {
  std::vector<const MotionCase*> chosen;
  if (names.empty()) {
    for (const MotionCase& each : test::motion_cases()) chosen.push_back(&each);
  }
  for (const std::string& name : names) chosen.push_back(&test::motion_case(name));
  return chosen;
}

class Benchmark {
 public:
  explicit Benchmark(const Options& options)
      : options_(options),
        pipelines_(chosen_pipelines(options.pipelines)),
        cases_(chosen_cases(options.cases)) {
    if (!options.middlebury.empty()) pairs_ = read_pairs(options.middlebury);
    if (options.csv.empty()) return;
    csv_ = std::fopen(options.csv.c_str(), "w");
    if (!csv_) throw std::runtime_error(options.csv + ": cannot be written");
    std::fputs(kCsvHeader, csv_);
  }
  ~Benchmark() {
    if (csv_) std::fclose(csv_);
  }
  Benchmark(const Benchmark&) = delete;
  Benchmark& operator=(const Benchmark&) = delete;

  void run() {
    for (const auto& [width, height] : options_.sizes) {
      const CaseScores scores = score(width, height, CaseGroup::kUsual);
      std::vector<Score> sum(pipelines_.size());
      for (const auto& [name, each] : scores) {
        for (size_t k = 0; k < sum.size(); ++k) sum[k].add(each[k]);
      }
      if (scores.empty()) continue;
      print_usual(std::to_string(width) + "x" + std::to_string(height), pipelines_, sum);
      write(width, height, "usual", sum);
    }
    const CaseScores hard = score(kHardWidth, kHardHeight, CaseGroup::kHard);
    if (!hard.empty()) print_hard(pipelines_, hard);
    const CaseScores silent = score(kHardWidth, kHardHeight, CaseGroup::kSilent);
    if (!silent.empty()) print_silent(pipelines_, silent);
    if (!pairs_.empty()) run_pairs();
  }

 private:
  std::deque<Runner> runners() const {
    std::deque<Runner> all;
    for (const Pipeline& pipeline : pipelines_) all.emplace_back(pipeline);
    return all;
  }

  void write(int width, int height, const std::string& name, const std::vector<Score>& scores) {
    if (csv_) write_csv(csv_, width, height, name, pipelines_, scores);
  }

  /// Cases of a group at one size; those that cannot be made are named and left out.
  CaseScores score(int width, int height, CaseGroup group) {
    CaseScores scores;
    for (const MotionCase* each : cases_) {
      if (each->group == group)
        scores.emplace_back(each->name, std::vector<Score>(pipelines_.size()));
    }
    std::deque<Runner> all = runners();
    const int scenes =
        group == CaseGroup::kUsual ? options_.scenes : std::max(options_.scenes, kHardScenes);
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
        const std::vector<Score> found = run_all(all, film, frames, options_.rounds);
        for (size_t k = 0; k < found.size(); ++k) sums[k].add(found[k]);
      }
    }
    for (const auto& [name, sums] : scores) write(width, height, name, sums);
    return scores;
  }

  void run_pairs() {
    std::deque<Runner> all = runners();
    std::vector<Score> scores(all.size());
    for (const FlowPair& pair : pairs_) {
      for (size_t k = 0; k < all.size(); ++k) all[k].run(pair, scores[k]);
    }
    print_pairs(pipelines_, scores);
    write(pairs_[0].before.width, pairs_[0].before.height, "middlebury", scores);
  }

  Options options_;
  std::vector<Pipeline> pipelines_;
  std::vector<const MotionCase*> cases_;
  std::vector<FlowPair> pairs_;
  std::FILE* csv_ = nullptr;
};

void list() {
  std::puts("cases:");
  for (const MotionCase& each : test::motion_cases()) std::printf("  %s\n", each.name.c_str());
  std::puts("pipelines:");
  for (const Pipeline& p : pipelines()) {
    std::printf("  %-10s %s\n", p.name.c_str(), p.description.c_str());
  }
}

}  // namespace

int main(int argc, char** argv) {
  gst_init(nullptr, nullptr);
  cv::setNumThreads(1);
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);  // a table when it is known, into files too
  try {
    if (argc == 2 && std::string(argv[1]) == "--list") {
      list();
      return 0;
    }
    Benchmark(parse_options(argc, argv)).run();
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "bench_tracking: %s\n%s", error.what(), kUsage);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_tracking: %s\n", error.what());
    return 1;
  }
  return 0;
}
