// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Time of the analysis, beside what OpenCV offers, and error of the dominant object's motion
// against the background on films of known motion.
//   ms      processor time of a frame on one thread
//   error   px a frame at a width of 640; of a frame without an object, what it moved
//   missed  frames in which an object in view is not found; ghosts: with one in films that have
//   none
//   spidar-bench tracking [WIDTHxHEIGHT…] [METHOD…]
// Methods are those of flow_methods.h; without any, all of the comparison.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <opencv2/core/utility.hpp>

#include "tests/bench/benchmarks.h"
#include "tests/bench/call_timer.h"
#include "tests/bench/film_frames.h"
#include "tests/bench/flow_methods.h"
#include "tests/support/motion_cases.h"

namespace {

using namespace spidar;
using namespace spidar::bench;
using Eigen::Vector2d;

constexpr int64_t kFrame_ns = 33'333'333;
constexpr double kReferenceWidth_px = 640;

/// Over all films of a size.
class Errors {
 public:
  /// `found_px`: motion since the frame before, zero where nothing is found.
  void add(const test::Film& film, int frame, const Vector2d& found_px) {
    const bool found = !found_px.isZero(0);
    ghost_frames_ += film.objects.empty();
    ghosts_ += film.objects.empty() && found;
    const double unit = kReferenceWidth_px / film.width();
    double least_px = -1;  // of several objects, that whose motion is nearest
    for (const test::FilmObject& object : film.objects) {
      if (!film.is_in_view(frame, object)) continue;
      const Vector2d moved_px = film.object_displacement_px(
          frame, object, object.centre_px(frame - 1) + film.middle_px());
      const double error_px = unit * (found_px - moved_px).norm();
      if (least_px < 0 || error_px < least_px) least_px = error_px;
    }
    if (least_px < 0) return;
    error_px_.push_back(least_px);
    missed_ += !found;
  }
  void print() const {
    std::printf("| %.3f | %.3f | %.1f | %.1f |\n", quantile(error_px_, 0.5),
                quantile(error_px_, 0.95), 100.0 * missed_ / static_cast<double>(error_px_.size()),
                100.0 * ghosts_ / ghost_frames_);
  }

 private:
  std::vector<double> error_px_;
  int missed_ = 0, ghosts_ = 0, ghost_frames_ = 0;
};

double thread_ms() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

void measure(int width, int height, const std::vector<std::string>& methods) {
  struct Measured {
    std::string name;
    std::unique_ptr<Method> method;
    std::vector<double> ms;
    Errors errors;
  };
  std::vector<Measured> all;
  for (const std::string& name : methods) all.push_back({name, nullptr, {}, {}});
  for (const test::MotionCase& each : test::motion_cases()) {
    if (each.group != test::CaseGroup::kUsual) continue;
    test::Film film = each.film(width, height, 1);
    std::vector<test::Picture> frames = draw_all(film, test::kFilmFrames);
    try {
      if (each.coded) frames = coded(frames);
    } catch (const std::runtime_error& error) {
      std::printf("%s is left out: %s\n", each.name.c_str(), error.what());
      continue;
    }
    for (Measured& one : all) one.method = make_method(one.name);
    for (size_t n = 0; n < frames.size(); ++n) {
      for (Measured& one : all) {  // in turn, so that what disturbs hits all
        const double begin_ms = thread_ms();
        const Vector2d found_px =
            one.method->find(frames[n].view(), static_cast<int64_t>(n) * kFrame_ns);
        if (n == 0) continue;
        one.ms.push_back(thread_ms() - begin_ms);
        one.errors.add(film, static_cast<int>(n), found_px);
      }
    }
  }
  std::printf(
      "\n### %dx%d\n\n| | ms median | 99 %% | error median | 95 %% | missed %% | ghosts %% |\n"
      "|---|---|---|---|---|---|---|\n",
      width, height);
  for (const Measured& one : all) {
    std::printf("| %s | %.2f | %.2f ", one.name.c_str(), quantile(one.ms, 0.5),
                quantile(one.ms, 0.99));
    one.errors.print();
  }
}

}  // namespace

int spidar::bench::tracking(int argc, char** argv) {
  cv::setNumThreads(1);
  std::vector<std::pair<int, int>> sizes;
  std::vector<std::string> methods;
  for (int i = 1; i < argc; ++i) {
    int width = 0, height = 0;
    if (std::sscanf(argv[i], "%dx%d", &width, &height) != 2) {
      make_method(argv[i]);  // throws when there is none
      methods.emplace_back(argv[i]);
    } else if (width >= 64 && height >= 64) {
      sizes.emplace_back(width, height);
    } else {
      throw std::invalid_argument(std::string(argv[i]) + " is not a size such as 640x360");
    }
  }
  if (sizes.empty()) sizes = {{640, 360}, {1280, 720}};
  if (methods.empty()) methods = method_names();
  for (const auto& [width, height] : sizes) measure(width, height, methods);
  return 0;
}
