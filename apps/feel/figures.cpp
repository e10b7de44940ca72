// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "apps/feel/figures.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "core/force/motion_rendering.h"

namespace spidar {
namespace {

/// Ranks from 1 for the smallest value; equal values share the mean of their ranks.
std::vector<double> ranks(const std::vector<double>& values) {
  std::vector<size_t> order(values.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](size_t i, size_t j) { return values[i] < values[j]; });
  std::vector<double> result(values.size());
  for (size_t begin = 0; begin < order.size();) {
    size_t end = begin + 1;
    while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
    const double rank = static_cast<double>(begin + 1 + end) / 2;
    for (size_t i = begin; i < end; ++i) result[order[i]] = rank;
    begin = end;
  }
  return result;
}

/// Speed as the eye sees it, in px/s of the reference frame: growth and roll count as in the
/// rendering.
double seen_px_s(const ImageMotion& motion, int height) {
  const Eigen::Vector2d velocity_px_s = kReferenceHeight_px / height * motion.velocity_px_s;
  return std::hypot(velocity_px_s.norm(), kRim_px * motion.growth_1_s, kRim_px * motion.roll_rad_s);
}

}  // namespace

double rank_correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const std::vector<double> rank_a = ranks(a);
  const std::vector<double> rank_b = ranks(b);
  const double mean = static_cast<double>(a.size() + 1) / 2;
  double ab = 0, aa = 0, bb = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    ab += (rank_a[i] - mean) * (rank_b[i] - mean);
    aa += (rank_a[i] - mean) * (rank_a[i] - mean);
    bb += (rank_b[i] - mean) * (rank_b[i] - mean);
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

FeelFigures feel(const Film& film, const FilterSettings& filter_settings,
                 const ControllerSettings& controller_settings) {
  const auto controller = make_controller(controller_settings);
  MotionFilter filter;
  FeelFigures figures;
  std::vector<double> speeds, forces;
  Wrench before;
  double all_s = 0, moving_s = 0;
  for (const FilmFrame& frame : film.frames) {
    if (frame.interval_s == 0) {
      filter.reset();
      before = Wrench();
      continue;
    }
    const ImageMotion steady =
        filter.filter(frame.motion, film.height, frame.interval_s, filter_settings);
    const Wrench wrench = render_motion(*controller, steady, {}, film.height, frame.interval_s);
    const double force_N = size_N(wrench);
    const double change_N = size_N(wrench - before);
    const double larger_N = std::max(force_N, size_N(before));
    before = wrench;
    all_s += frame.interval_s;
    const double speed_px_s = seen_px_s(frame.motion, film.height);
    if (speed_px_s < kMoving_px_s) continue;
    moving_s += frame.interval_s;
    speeds.push_back(speed_px_s);
    forces.push_back(force_N);
    figures.mean_force_N += frame.interval_s * force_N;
    if (force_N >= kFeltForce_N) figures.felt += frame.interval_s;
    if (force_N >= kAtLimit * controller_settings.max_force_N) figures.at_limit += frame.interval_s;
    if (change_N > kWeberFraction * larger_N && change_N > kFeltForce_N) {
      figures.told_apart += frame.interval_s;
    }
  }
  if (moving_s == 0) return figures;
  figures.moving = moving_s / all_s;
  figures.felt /= moving_s;
  figures.at_limit /= moving_s;
  figures.told_apart /= moving_s;
  figures.mean_force_N /= moving_s;
  figures.rank = rank_correlation(speeds, forces);
  return figures;
}

}  // namespace spidar
