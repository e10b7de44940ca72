#include "core/motion/object_clusters.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/motion/robust_fit.h"

namespace spidar {
namespace {

/// Neighbours agree when their displacements differ by less than the noise of a difference allows
/// (3 √2 σ), plus a share of the displacement, plus what turning and growing make of the distance
/// between near ones.
constexpr double kAgreeSigmas = 4.3;
constexpr double kAgreeShare = 0.1;
constexpr double kAgreePerDistance = 0.03;

/// Windows on an object see its edge too, the more the faster it is: more noise than elsewhere.
constexpr double kObjectNoise = 1.5;
constexpr double kObjectNoiseShare = 0.03;

/// A translation with a mean of ρ below this needs no similarity.
constexpr double kExplained = 1.0;
constexpr size_t kLeastForSimilarity = 6;
/// Σ |d|² / σ² over a group: few tracks must be fast, or slow ones many.
constexpr double kLeastEvidence = 100;
/// One track more is asked of a group for so many that are in none: the more go astray, the
/// likelier it is that some agree by chance.
constexpr size_t kStraysPerTrack = 16;

/// Disjoint sets over 0 … n − 1.
class Sets {
 public:
  Sets(size_t n, std::pmr::memory_resource* memory) : parent_(n, memory) {
    std::iota(parent_.begin(), parent_.end(), size_t{0});
  }
  size_t find(size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(size_t i, size_t j) {
    i = find(i);
    j = find(j);
    parent_[std::max(i, j)] = std::min(i, j);
  }

 private:
  std::pmr::vector<size_t> parent_;
};

bool agree(const Displacement& a, const Displacement& b, const ClusterSettings& settings) {
  const double distance2 = (a.at_px - b.at_px).squaredNorm();
  if (distance2 > settings.reach_px * settings.reach_px) return false;
  const double fastest_px = std::sqrt(std::max(a.moved_px.squaredNorm(), b.moved_px.squaredNorm()));
  const double tolerance_px =
      kAgreeSigmas * settings.sigma_px + kAgreeShare * fastest_px +
      kAgreePerDistance * std::min(std::sqrt(distance2), settings.reach_px / 4);
  return (a.moved_px - b.moved_px).squaredNorm() < tolerance_px * tolerance_px;
}

}  // namespace

ClusterFinder::ClusterFinder() {
  evidence_.points.reserve(kMostDisplacements);
  evidence_.weights.reserve(kMostDisplacements);
}

/// Translation, or similarity when that is better by GRIC.
MotionModel ClusterFinder::own_motion() {
  const auto translation = fitter_.fit(ModelKind::kTranslation, evidence_);
  if (!translation) return MotionModel();
  evidence_.sigma_px =
      std::max(evidence_.sigma_px, kObjectNoiseShare * translation->shift_px.norm());
  const double n = static_cast<double>(evidence_.points.size());
  const double cost = robust_cost(*translation, evidence_);
  if (cost <= kExplained * n || evidence_.points.size() < kLeastForSimilarity) return *translation;
  const auto similarity = fitter_.fit(ModelKind::kSimilarity, evidence_);
  // Two parameters more, and two more so that it does not flicker.
  const double price = 4 * std::log(4 * n);
  if (similarity && robust_cost(*similarity, evidence_) + price < cost) return *similarity;
  return *translation;
}

Cluster ClusterFinder::describe(const std::vector<Displacement>& points, Indices group,
                                double sigma_px) {
  Cluster cluster(std::move(group));
  if (cluster.group.empty()) return cluster;
  evidence_.points.clear();
  for (const int i : cluster.group) evidence_.points.push_back(points[static_cast<size_t>(i)]);
  evidence_.weights.assign(cluster.group.size(), 1.0);
  evidence_.sigma_px = kObjectNoise * sigma_px;
  cluster.motion = own_motion();

  cluster.members.reserve(cluster.group.size());
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e300);
  Eigen::Vector2d high = -low;
  for (size_t k = 0; k < cluster.group.size(); ++k) {
    const Displacement& point = evidence_.points[k];
    if (point_cost(cluster.motion, point, evidence_.sigma_px) >= kMostCost) continue;
    cluster.members.push_back(cluster.group[k]);
    cluster.position_px += point.at_px;
    low = low.cwiseMin(point.at_px);
    high = high.cwiseMax(point.at_px);
  }
  if (cluster.members.empty()) return cluster;
  cluster.position_px /= static_cast<double>(cluster.members.size());
  cluster.size_px = high - low;
  cluster.moved_px = cluster.motion.displacement_px(cluster.position_px);
  return cluster;
}

std::pmr::vector<Cluster> ClusterFinder::find(const std::vector<Displacement>& points,
                                              const Indices& candidates,
                                              const ClusterSettings& settings) {
  std::pmr::memory_resource* const memory = candidates.get_allocator().resource();
  const auto point = [&](size_t k) -> const Displacement& {
    return points[static_cast<size_t>(candidates[k])];
  };
  Sets sets(candidates.size(), memory);
  for (size_t i = 0; i < candidates.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      if (agree(point(i), point(j), settings)) sets.join(i, j);
    }
  }
  std::pmr::vector<Indices> groups(candidates.size(), memory);
  for (size_t i = 0; i < candidates.size(); ++i) groups[sets.find(i)].push_back(candidates[i]);

  std::pmr::vector<Cluster> clusters(memory);
  clusters.reserve(candidates.size() / kLeastInCluster);
  for (Indices& group : groups) {
    if (group.size() < kLeastInCluster) continue;
    Cluster cluster = describe(points, std::move(group), settings.sigma_px);
    if (cluster.members.size() < kLeastInCluster) continue;
    double evidence = 0;
    for (const int i : cluster.members) {
      evidence += points[static_cast<size_t>(i)].moved_px.squaredNorm();
    }
    if (evidence < kLeastEvidence * settings.sigma_px * settings.sigma_px) continue;
    clusters.push_back(std::move(cluster));
  }
  size_t strays = candidates.size();
  for (const Cluster& cluster : clusters) strays -= cluster.members.size();
  const size_t least = kLeastInCluster + strays / kStraysPerTrack;
  clusters.erase(
      std::remove_if(clusters.begin(), clusters.end(),
                     [least](const Cluster& cluster) { return cluster.members.size() < least; }),
      clusters.end());
  std::sort(clusters.begin(), clusters.end(), [](const Cluster& a, const Cluster& b) {
    if (a.members.size() != b.members.size()) return a.members.size() > b.members.size();
    return a.group.front() < b.group.front();  // no two are equal: the order is determined
  });
  return clusters;
}

}  // namespace spidar
