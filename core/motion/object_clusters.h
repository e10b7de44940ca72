/// Tracks that hang together in place and motion.
#pragma once

#include <memory_resource>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/api.h"
#include "core/motion/motion_models.h"
#include "core/motion/robust_fit.h"

namespace spidar {

/// Of displacements. For as long as a frame is looked at: see FrameMemory.
using Indices = std::pmr::vector<int>;

/// A group of tracks that moves as one.
struct Cluster {
  explicit Cluster(Indices hanging_together)
      : group(std::move(hanging_together)), members(group.get_allocator()) {}

  Indices group;       ///< all that hang together
  Indices members;     ///< those of them that `motion` explains
  MotionModel motion;  ///< translation or similarity, about the frame's centre
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

constexpr size_t kLeastInCluster = 3;

/// Keeps nothing from one call to the next but its memory.
class SPIDAR_API ClusterFinder {
 public:
  ClusterFinder();

  /// Groups of at least kLeastInCluster among the `candidates` (indices of `points`): neighbours in
  /// place whose displacements agree are in the same group. What is then not explained by one
  /// motion is dropped: tracks that see more than one thing, and groups that are but noise. The
  /// largest group is first. Displacements may be relative to anything. Quadratic in the number of
  /// candidates, which kMostDisplacements bounds. The result is in the memory of the candidates.
  std::pmr::vector<Cluster> find(const std::vector<Displacement>& points, const Indices& candidates,
                                 const ClusterSettings& settings);

  /// Motion, place and size of a given group: the lowest of translation and similarity by GRIC,
  /// both without those that it does not explain.
  Cluster describe(const std::vector<Displacement>& points, Indices group, double sigma_px);

 private:
  MotionModel own_motion();

  WeightedTracks evidence_;
  RobustFitter fitter_;
};

}  // namespace spidar
