// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/tracking/score.h"

#include <algorithm>
#include <cmath>

namespace spidar::bench {
namespace {

using Eigen::Vector2d;

Vector2d vector(const ImagePoint& p) {
  return Vector2d(static_cast<double>(p.x_px), static_cast<double>(p.y_px));
}

double to_reference(const test::Film& film) {
  return kReferenceWidth_px / film.width();
}

Vector2d mean_displacement_px(const std::vector<Track>& tracks) {
  constexpr int64_t kSecond_ns = 1'000'000'000;
  return mean_motion(tracks, kSecond_ns).velocity_px_s;
}

/// True motion of an object in view, against the background. Of several, that whose motion is
/// nearest to `found_px`.
struct Truth {
  Vector2d moved_px;
  double error_px;
};

template <typename At>
std::optional<Truth> nearest(const test::Film& film, int frame, const Vector2d& found_px,
                             At&& at_px) {
  std::optional<Truth> best;
  for (const test::FilmObject& object : film.objects) {
    if (!film.is_in_view(frame, object)) continue;
    const Vector2d moved_px = film.object_displacement_px(frame, object, at_px(object));
    const double error_px = (found_px - moved_px).norm();
    if (!best || error_px < best->error_px) best = Truth{moved_px, error_px};
  }
  return best;
}

}  // namespace

void Score::add_tracks(const TrackedFrame& tracked, int were_looked_for,
                       const std::function<std::optional<Vector2d>(const Vector2d&)>& truth,
                       double unit) {
  looked_for += were_looked_for;
  lost += std::max<long>(0, were_looked_for - static_cast<long>(tracked.tracks.size()));
  for (const Track& track : tracked.tracks) {
    const Vector2d from_px = vector(track.from);
    const std::optional<Vector2d> true_px = truth(from_px);
    if (!true_px) continue;
    const double error_px = (vector(track.to) - from_px - *true_px).norm();
    epe_px.push_back(error_px);
    wrong += error_px * unit > 1;
  }
}

void Score::add_motion(const test::Film& film, int frame, const TrackedFrame& tracked,
                       const MeasuredFrame* scene, double interval_s) {
  const double unit = to_reference(film);
  const Vector2d mean_px = mean_displacement_px(tracked.tracks);
  largest_mean = std::max(largest_mean, mean_px.norm() * unit);
  const MovingObject* found = scene ? scene->dominant_object() : nullptr;
  Vector2d found_px = Vector2d::Zero();
  if (found) found_px = found->relative_px_s * interval_s;
  largest_object = std::max(largest_object, found_px.norm() * unit);
  if (film.objects.empty()) {
    without_object += scene != nullptr;
    ghosts += found_px != Vector2d::Zero();
    return;
  }
  const auto centre_px = [&](const test::FilmObject& object) -> Vector2d {
    return object.centre_px(frame - 1) + film.middle_px();
  };
  const std::optional<Truth> mean_truth = nearest(film, frame, mean_px, centre_px);
  if (!mean_truth) return;
  mean_error.push_back(mean_truth->error_px * unit);
  if (!scene) return;
  if (found_px == Vector2d::Zero()) {
    ++missed;
    object_error.push_back(nearest(film, frame, found_px, centre_px)->error_px * unit);
    return;
  }
  // Of an object that turns, the truth is that of the place that the velocity is said to be of.
  const Vector2d place_px =
      found->position_px - found->on_screen_px_s * interval_s + film.middle_px();
  object_error.push_back(
      nearest(film, frame, found_px, [&](const test::FilmObject&) { return place_px; })->error_px *
      unit);
}

void Score::add(const Score& other) {
  const auto append = [](std::vector<double>& to, const std::vector<double>& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  append(ms, other.ms);
  append(epe_px, other.epe_px);
  append(mean_error, other.mean_error);
  append(object_error, other.object_error);
  looked_for += other.looked_for;
  lost += other.lost;
  wrong += other.wrong;
  missed += other.missed;
  without_object += other.without_object;
  ghosts += other.ghosts;
  largest_mean = std::max(largest_mean, other.largest_mean);
  largest_object = std::max(largest_object, other.largest_object);
}

}  // namespace spidar::bench
