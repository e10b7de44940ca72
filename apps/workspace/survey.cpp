// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "apps/workspace/survey.h"

#include <algorithm>
#include <cstdio>
#include <random>

#include "apps/workspace/delivery.h"
#include "apps/workspace/force_closure.h"
#include "core/quantile.h"

namespace {

using spidar::quantile;

constexpr int kPoses = 4000;  // a share is then known to ±0.8 % (one standard deviation) or better
constexpr int kDirections = 32;
constexpr unsigned kSeed = 1;
constexpr double kDegree = M_PI / 180;

/// Results of one choice of weights, for each pose.
class Tally {
 public:
  Tally(const spidar::Profile& profile, const Weights& weights) : deliverer_(profile, weights) {}

  void add(const spidar::StructureMatrix& W, const std::vector<Eigen::Vector3d>& directions) {
    deliverer_.go_to(W);
    for (const Eigen::Vector3d& direction : directions) {
      const Delivery delivery = deliverer_.deliver(direction);
      force_N_.push_back(delivery.force_N);
      moment_Nm_.push_back(delivery.moment_Nm);
    }
  }

  DeliverySummary summary() {
    return {quantile(force_N_, 0.5), quantile(force_N_, 0.05), quantile(moment_Nm_, 0.5),
            quantile(moment_Nm_, 0.95)};
  }

 private:
  Deliverer deliverer_;
  std::vector<double> force_N_, moment_Nm_;
};

class RandomPose {
 public:
  explicit RandomPose(const Region& region) : region_(region) {}

  spidar::Pose operator()() {
    std::uniform_real_distribution<double> side(-1, 1);
    std::normal_distribution<double> normal;
    spidar::Pose pose;
    Eigen::Vector3d axis;
    for (int k = 0; k < 3; ++k) {
      pose.position_m[k] = region_.reach_m[k] * side(random_);
      axis[k] = normal(random_);
    }
    pose.orientation = Eigen::AngleAxisd(region_.angle_rad * side(random_), axis.normalized());
    return pose;
  }

 private:
  const Region& region_;
  std::mt19937_64 random_{kSeed};
};

void print_row(const spidar::Profile& profile, const std::vector<Survey>& surveys) {
  std::printf("| `%s` |", profile.name.c_str());
  for (const Survey& s : surveys)
    std::printf(" %.0f / %.0f / %.0f |", 100 * s.closed, 100 * s.balanced, 100 * s.feasible);
  std::printf("\n");
}

void print_row(const spidar::Profile& profile, const Survey& survey) {
  std::printf("| `%s` |", profile.name.c_str());
  for (const DeliverySummary& d : {survey.loop, survey.published})
    std::printf(" %.2f | %.2f | %.1f | %.1f |", d.force_median_N, d.force_5_N,
                1e3 * d.moment_median_Nm, 1e3 * d.moment_95_Nm);
  std::printf("\n");
}

}  // namespace

Eigen::Vector3d frame_half_size_m(const spidar::Profile& profile) {
  Eigen::Vector3d half = Eigen::Vector3d::Zero();
  for (int i = 0; i < profile.geometry.count; ++i)
    half = half.cwiseMax(profile.geometry.exit_m[static_cast<size_t>(i)].cwiseAbs());
  return half;
}

std::vector<Region> regions(const spidar::Profile& profile) {
  return {{"±5 mm, 10°", Eigen::Vector3d::Constant(0.005), 10 * kDegree},
          {"±2 cm, 20°", Eigen::Vector3d::Constant(0.02), 20 * kDegree},
          {"±2 cm, 60°", Eigen::Vector3d::Constant(0.02), 60 * kDegree},
          {"±5 cm, 80°", Eigen::Vector3d::Constant(0.05), 80 * kDegree},
          {"frame, 20°", frame_half_size_m(profile), 20 * kDegree}};
}

Survey survey(const spidar::Profile& profile, const Region& region) {
  const Weights loop = loop_weights(profile);
  Weights exact = loop;
  exact.epsilon = 1e-12;
  Deliverer exact_deliverer(profile, exact);
  Tally loop_tally(profile, loop), published_tally(profile, published_weights());
  const std::vector<Eigen::Vector3d> directions = even_directions(kDirections);
  RandomPose random_pose(region);

  Survey survey;
  for (int n = 0; n < kPoses; ++n) {
    const spidar::StructureMatrix W = spidar::structure_matrix(profile.geometry, random_pose());
    const ForceClosure closure = force_closure(W, profile.geometry.count, loop.torque_length_m,
                                               profile.min_tension_N(), profile.max_tension_N());
    exact_deliverer.go_to(W);
    survey.closed += closure.tension_factor > 0;
    survey.balanced += closure.balanced_within_bounds;
    survey.feasible += std::all_of(directions.begin(), directions.end(), [&](const auto& d) {
      return exact_deliverer.delivers_exactly(d);
    });
    loop_tally.add(W, directions);
    published_tally.add(W, directions);
  }
  for (double* share : {&survey.closed, &survey.balanced, &survey.feasible}) *share /= kPoses;
  survey.loop = loop_tally.summary();
  survey.published = published_tally.summary();
  return survey;
}

void print_surveys(const std::vector<spidar::Profile>& profiles) {
  std::vector<std::vector<Survey>> surveys;
  for (const spidar::Profile& profile : profiles) {
    surveys.emplace_back();
    for (const Region& region : regions(profile)) surveys.back().push_back(survey(profile, region));
  }
  if (profiles.empty()) return;
  const std::vector<Region> named = regions(profiles.front());

  std::printf(
      "Share of poses, %%: force closure / balanced within bounds / %g N in every "
      "direction\n\n| profile |",
      kWanted_N);
  for (const Region& region : named) std::printf(" %s |", region.name.c_str());
  std::printf("\n|---|");
  for (size_t k = 0; k < named.size(); ++k) std::printf("---|");
  std::printf("\n");
  for (size_t i = 0; i < profiles.size(); ++i) print_row(profiles[i], surveys[i]);

  for (size_t k = 0; k < named.size(); ++k) {
    std::printf(
        "\nDelivered of %g N without torque, %s: force in N (median, 5 %%), stray moment in "
        "N mm (median, 95 %%)\n\n"
        "| profile | loop | 5 %% | moment | 95 %% | published | 5 %% | moment | 95 %% |\n"
        "|---|---|---|---|---|---|---|---|---|\n",
        kWanted_N, named[k].name.c_str());
    for (size_t i = 0; i < profiles.size(); ++i) print_row(profiles[i], surveys[i][k]);
  }
}
