/// What moves beyond the background.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/api.h"
#include "core/motion/background.h"
#include "core/motion/frame_memory.h"
#include "core/motion/motion_models.h"
#include "core/motion/object_clusters.h"

namespace spidar {

/// One object in one frame. Image frame I about the centre of the frame: x right, y down.
struct MovingObject {
  uint32_t id = 0;  ///< the same for as long as it lives, never used again
  Eigen::Vector2d position_px = Eigen::Vector2d::Zero();     ///< of its middle
  Eigen::Vector2d size_px = Eigen::Vector2d::Zero();         ///< of the box around its tracks
  Eigen::Vector2d relative_px_s = Eigen::Vector2d::Zero();   ///< velocity against the background
  Eigen::Vector2d on_screen_px_s = Eigen::Vector2d::Zero();  ///< velocity that the viewer sees
  double growth_1_s = 0;                                     ///< see ImageMotion, both against …
  double roll_rad_s = 0;                                     ///< … the background
  ModelKind model = ModelKind::kTranslation;                 ///< translation or similarity
  int tracks = 0;                                            ///< 0 while it is out of sight
  double noise_px_s = 0;  ///< standard error of each coordinate of relative_px_s
  /// Area × speed, smoothed over kProminence_s: what one would look at.
  double prominence = 0;

  /// Box with a margin of the space between tracks: a few tracks in a row have an area, too.
  double area_px2() const { return (size_px.x() + kMargin_px) * (size_px.y() + kMargin_px); }
  static constexpr double kMargin_px = 10;
  static constexpr double kProminence_s = 0.5;
};

/// Objects from frame to frame. Tracks that the background does not explain (further than 3 σ) and
/// that hang together are an object from the second frame on in which they do. The tracks that it
/// had before say which object a group is, and failing that, place and velocity: so it stays the
/// same when another one crosses or hides it. It dies when it is out of sight for kForgotten_s or
/// at rest for kAtRest_s; until then it may stand still.
class SPIDAR_API ObjectTracker {
 public:
  ObjectTracker();

  /// Tracks between two frames of `width` × `height` pixels that are shown `interval_s` apart, and
  /// the background that they have. Valid until the next call; in the order of birth.
  const std::vector<MovingObject>& update(const std::vector<Displacement>& points,
                                          const Background& background, int width, int height,
                                          double interval_s);

  /// A cut, a seek: nothing is known.
  void reset();

  static constexpr double kForgotten_s = 0.5;
  static constexpr double kAtRest_s = 1.0;
  static constexpr size_t kMostObjects = 16;

 private:
  struct Life {
    MovingObject object;
    std::vector<uint32_t> track_ids;  ///< sorted
    int frames_seen = 0;
    double unseen_s = 0;
    double resting_s = 0;
    std::vector<int> group;  ///< that it has in this frame, indices of its points
    bool claimed = false;    ///< by a group of this frame
  };
  using Clusters = std::pmr::vector<Cluster>;
  struct Frame {
    const Background* background;
    double interval_s;
    double reach_px;
    double sigma_px;
  };

  Clusters find_relative(const std::vector<Displacement>& points, const Frame& frame);
  void claim_by_tracks(Clusters& clusters, const Frame& frame);
  /// In place and motion.
  static bool belongs(const Cluster& cluster, const Life& life, const Frame& frame);
  void claim_by_place(Clusters& clusters, const Frame& frame);
  void bear(const Clusters& clusters, const Frame& frame);
  void live(Life& life, const Frame& frame);
  template <typename Dead>
  void drop(Dead&& dead);
  void see(Life& life, const Cluster& cluster, const Frame& frame);

  FrameMemory memory_;
  ClusterFinder finder_;
  std::vector<Displacement> relative_;  ///< to the background
  std::vector<Life> lives_;
  std::vector<Life> spare_;  ///< their memory is for those to be born
  std::vector<MovingObject> objects_;
  uint32_t next_id_ = 1;
};

}  // namespace spidar
