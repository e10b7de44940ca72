/// Tracks that hang together in place and motion.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/api.h"
#include "core/motion/motion_models.h"

namespace spidar {

/// A group of tracks that moves as one.
struct Cluster {
  std::vector<int> group;    ///< all that hang together, indices of the displacements given
  std::vector<int> members;  ///< those of them that `motion` explains
  MotionModel motion;        ///< translation or similarity, about the frame's centre
  Eigen::Vector2d position_px =
      Eigen::Vector2d::Zero();                         ///< of its middle, from the frame's centre
  Eigen::Vector2d size_px = Eigen::Vector2d::Zero();   ///< of the box around its tracks
  Eigen::Vector2d moved_px = Eigen::Vector2d::Zero();  ///< displacement of its middle

  /// Most of the group moves so: it is not but the densest place of some noise.
  bool is_coherent() const { return 2 * members.size() >= group.size(); }
};

struct ClusterSettings {
  double reach_px = 0;  ///< neighbours are not further apart
  double sigma_px = 0;  ///< noise of a displacement, each coordinate
};

/// Groups of at least kLeastInCluster among the `candidates` (indices of `points`): neighbours in
/// place whose displacements agree are in the same group. What is then not explained by one motion
/// is dropped: tracks that see more than one thing, and groups that are but noise. The largest
/// group is first. Displacements may be relative to anything.
/// Quadratic in the number of candidates, which kMostDisplacements bounds.
SPIDAR_API std::vector<Cluster> find_clusters(const std::vector<Displacement>& points,
                                              const std::vector<int>& candidates,
                                              const ClusterSettings& settings);
constexpr size_t kLeastInCluster = 3;

/// Motion, place and size of a given group: the lowest of translation and similarity by GRIC, both
/// without those that it does not explain.
SPIDAR_API Cluster describe_cluster(const std::vector<Displacement>& points, std::vector<int> group,
                                    double sigma_px);

}  // namespace spidar
