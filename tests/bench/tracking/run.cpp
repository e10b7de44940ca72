// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/tracking/run.h"

#include <cmath>
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

Runner::Runner(const Pipeline& pipeline) : pipeline_(&pipeline), tracker_(pipeline.make()) {}

/// Points that begin within half the least distance of where another one ended are the same.
void Runner::link(int height) {
  const auto reach_px =
      static_cast<float>(TrackerSettings().min_distance_px / 2 * height / kReferenceHeight_px);
  for (Track& track : linked_.tracks) {
    track.id = next_id_++;
    float nearest_px = reach_px;
    for (const Track& old : before_) {
      const float distance_px =
          std::hypot(old.to.x_px - track.from.x_px, old.to.y_px - track.from.y_px);
      if (distance_px >= nearest_px) continue;
      nearest_px = distance_px;
      track.id = old.id;
    }
  }
  before_ = linked_.tracks;
}

void Runner::run(const test::Film& film, const std::vector<test::Picture>& frames, bool errors,
                 Score& score) {
  if (tracker_) tracker_->restart();
  motion_.reset();
  reduced_.restart();
  before_.clear();
  int looked_for = 0;
  for (size_t n = 0; n < frames.size(); ++n) {
    const int frame = static_cast<int>(n);
    const ImageView view = frames[n].view();
    const double begin_ms = thread_time_ms();
    const TrackedFrame* tracked = tracker_ ? &tracker_->track(view) : nullptr;
    double ms = thread_time_ms() - begin_ms;
    if (tracked && !pipeline_->keeps_ids) {
      linked_ = *tracked;
      link(film.height());
      tracked = &linked_;
    }
    const double middle_ms = thread_time_ms();
    reduced_.read(view);
    const SceneMotion scene = motion_.estimate(
        MotionKind::kObject, view, reduced_,
        {tracked, pipeline_->own_points.value_or(FieldPoints::Settings())}, kFrame_ns);
    ms += thread_time_ms() - middle_ms;
    if (!tracked) {
      own_.restarted = scene.restarted;
      own_.features = scene.features;
      own_.tracks.clear();
      if (scene.tracks) own_.tracks = *scene.tracks;
      tracked = &own_;
    }
    if (n > 0) score.ms.push_back(ms);
    if (n > 0 && errors) {
      if (film.is_comparable(frame)) {
        const auto truth = [&](const Eigen::Vector2d& from_px) -> std::optional<Eigen::Vector2d> {
          return film.displacement_px(frame, from_px);
        };
        score.add_tracks(*tracked, looked_for, truth, kReferenceWidth_px / film.width());
      }
      score.add_motion(film, frame, *tracked, scene, kFrame_s);
    }
    looked_for = tracked->features;
  }
}

void Runner::run(const FlowPair& pair, Score& score) {
  const auto truth = [&](const Eigen::Vector2d& from_px) {
    return pair.truth.at(from_px.x(), from_px.y());
  };
  const double unit = kReferenceWidth_px / pair.before.width;
  if (tracker_) {
    tracker_->restart();
    const int looked_for = tracker_->track(pair.before.view()).features;
    score.add_tracks(tracker_->track(pair.after.view()), looked_for, truth, unit);
    return;
  }
  motion_.reset();
  reduced_.restart();
  const MotionEstimator::Points points{nullptr, *pipeline_->own_points};
  for (const test::Picture* picture : {&pair.before, &pair.after}) {
    reduced_.read(picture->view());
    const SceneMotion scene =
        motion_.estimate(MotionKind::kObject, picture->view(), reduced_, points, kFrame_ns);
    if (!scene.tracks) continue;
    own_.tracks = *scene.tracks;
    own_.features = scene.features;
  }
  score.add_tracks(own_, static_cast<int>(own_.tracks.size()), truth, unit);
}

std::vector<Score> run_all(std::deque<Runner>& runners, const test::Film& film,
                           const std::vector<test::Picture>& frames, int rounds) {
  std::vector<Score> scores(runners.size());
  for (int round = 0; round < rounds; ++round) {
    for (size_t k = 0; k < runners.size(); ++k) {
      runners[k].run(film, frames, round == 0, scores[k]);
    }
  }
  return scores;
}

}  // namespace spidar::bench
