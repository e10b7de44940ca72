// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/tracking/run.h"

#include <ctime>

namespace spidar::bench {
namespace {

constexpr int64_t kFrame_ns = 33'333'333;
constexpr double kFrame_s = 1e-9 * static_cast<double>(kFrame_ns);

double thread_time_ms() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

}  // namespace

Runner::Runner(const Pipeline& pipeline)
    : pipeline_(&pipeline), peer_(pipeline.make ? pipeline.make() : nullptr) {}

/// motion=object of the next frame.
const MeasuredFrame& Runner::find_objects(const ImageView& frame) {
  reduced_.read(frame);
  scene_.forget_motion();
  scene_.interval_ns = kFrame_ns;
  motion_.estimate(frame, reduced_, scene_);
  return scene_;
}

void Runner::restart() {
  if (peer_) peer_->restart();
  motion_.reset();
  reduced_.restart();
}

void Runner::run(const test::Film& film, const std::vector<test::Picture>& frames, Score& score) {
  restart();
  int looked_for = 0;
  for (size_t n = 0; n < frames.size(); ++n) {
    const int frame = static_cast<int>(n);
    const ImageView view = frames[n].view();
    TrackedFrame tracked;
    const double begin_ms = thread_time_ms();
    if (peer_)
      tracked = peer_->track(view);
    else
      find_objects(view);
    const double ms = thread_time_ms() - begin_ms;
    if (!peer_) {
      tracked.features = scene_.features;
      tracked.tracks = scene_.tracks;
    }
    if (n > 0) score.ms.push_back(ms);
    if (n > 0) {
      if (film.is_comparable(frame)) {
        const auto truth = [&](const Eigen::Vector2d& from_px) -> std::optional<Eigen::Vector2d> {
          return film.displacement_px(frame, from_px);
        };
        score.add_tracks(tracked, looked_for, truth, kReferenceWidth_px / film.width());
      }
      score.add_motion(film, frame, tracked, peer_ ? nullptr : &scene_, kFrame_s);
    }
    looked_for = tracked.features;
  }
}

std::vector<Score> run_all(std::deque<Runner>& runners, const test::Film& film,
                           const std::vector<test::Picture>& frames) {
  std::vector<Score> scores(runners.size());
  for (size_t k = 0; k < runners.size(); ++k) runners[k].run(film, frames, scores[k]);
  return scores;
}

}  // namespace spidar::bench
