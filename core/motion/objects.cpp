#include "core/motion/objects.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spidar {
namespace {

/// Not explained by the background: P(χ²₂ > 9) = 1 % of its tracks.
constexpr double kMovingSigmas = 3;
/// Neighbours on an object, as a share of the frame's height: four times the space between tracks
/// when 200 of them fill the frame. Few hold on to a small object, and far apart.
constexpr double kReach = 1.0 / 4;
/// Groups are the same object when their displacements differ by less than this share, plus noise.
constexpr double kSameMotion = 0.3;
constexpr int kBornAfter = 2;
/// An object that is lost goes on for this long: tracks fail for a frame or two now and then.
constexpr double kCoast_s = 0.1;
constexpr size_t kLeastToSee = 2;
constexpr int kLeastVotes = 2;

/// For the candidates and groups of kMostDisplacements and the tracks of kMostObjects.
constexpr size_t kFrameMemory_bytes = 512 * 1024;

bool same_motion(const Eigen::Vector2d& a_px, const Eigen::Vector2d& b_px, double sigma_px) {
  const double fastest_px = std::max(a_px.norm(), b_px.norm());
  return (a_px - b_px).norm() < kSameMotion * fastest_px + kMovingSigmas * sigma_px;
}

bool owns(const std::vector<uint32_t>& sorted, uint32_t id) {
  return std::binary_search(sorted.begin(), sorted.end(), id);
}

}  // namespace

ObjectTracker::ObjectTracker() : memory_(kFrameMemory_bytes) {
  relative_.reserve(kMostDisplacements);
  lives_.reserve(kMostObjects);
  objects_.reserve(kMostObjects);
  spare_.resize(kMostObjects);
  for (Life& life : spare_) {
    life.track_ids.reserve(2 * kMostDisplacements);
    life.group.reserve(kMostDisplacements);
  }
}

void ObjectTracker::reset() {
  drop([](const Life&) { return true; });
  objects_.clear();
}

/// Displacements against the background, and the groups in them.
ObjectTracker::Clusters ObjectTracker::find_relative(const std::vector<Displacement>& points,
                                                     const Frame& frame) {
  relative_ = points;
  Indices moving(memory_.resource());
  moving.reserve(points.size());
  const double least_px = kMovingSigmas * frame.sigma_px;
  for (size_t i = 0; i < relative_.size(); ++i) {
    Displacement& point = relative_[i];
    point.moved_px -= frame.background->model.displacement_px(point.at_px);
    if (point.moved_px.squaredNorm() > least_px * least_px) moving.push_back(static_cast<int>(i));
  }
  return finder_.find(relative_, moving, {frame.reach_px, frame.sigma_px});
}

/// A group is the object that most of its tracks were on. Several groups may be one object, when
/// they move alike.
void ObjectTracker::claim_by_tracks(Clusters& clusters, const Frame& frame) {
  Clusters left(memory_.resource());
  left.reserve(clusters.size());
  for (Cluster& cluster : clusters) {
    Life* best = nullptr;
    int most_votes = 0;
    for (Life& life : lives_) {
      const auto votes =
          static_cast<int>(std::count_if(cluster.group.begin(), cluster.group.end(), [&](int i) {
            return owns(life.track_ids, relative_[static_cast<size_t>(i)].id);
          }));
      if (votes >= kLeastVotes && votes > most_votes) {
        most_votes = votes;
        best = &life;
      }
    }
    // Noise does not move alike twice.
    const bool unborn = best && best->frames_seen < kBornAfter;
    const bool must_agree = best && (best->claimed || unborn);
    if (!best || (unborn && !cluster.is_coherent()) ||
        (must_agree && !same_motion(best->object.relative_px_s * frame.interval_s, cluster.moved_px,
                                    frame.sigma_px))) {
      left.push_back(std::move(cluster));
      continue;
    }
    best->group.insert(best->group.end(), cluster.group.begin(), cluster.group.end());
    if (!best->claimed) best->object.relative_px_s = cluster.moved_px / frame.interval_s;
    best->claimed = true;
  }
  clusters = std::move(left);
}

bool ObjectTracker::belongs(const Cluster& cluster, const Life& life, const Frame& frame) {
  const Eigen::Vector2d moved_px = life.object.relative_px_s * frame.interval_s;
  return (life.object.position_px - cluster.position_px).norm() < frame.reach_px &&
         same_motion(moved_px, cluster.moved_px, frame.sigma_px);
}

/// A group without known tracks is the object that was to be expected there. What was seen only
/// once is not expected anywhere.
void ObjectTracker::claim_by_place(Clusters& clusters, const Frame& frame) {
  Clusters left(memory_.resource());
  left.reserve(clusters.size());
  for (Cluster& cluster : clusters) {
    Life* nearest = nullptr;
    double nearest_px = frame.reach_px;
    for (Life& life : lives_) {
      if (life.frames_seen < kBornAfter || !belongs(cluster, life, frame)) continue;
      const double distance_px = (life.object.position_px - cluster.position_px).norm();
      if (distance_px < nearest_px) {
        nearest_px = distance_px;
        nearest = &life;
      }
    }
    if (!nearest) {
      left.push_back(std::move(cluster));
      continue;
    }
    nearest->group.insert(nearest->group.end(), cluster.group.begin(), cluster.group.end());
    nearest->claimed = true;
  }
  clusters = std::move(left);
}

void ObjectTracker::bear(const Clusters& clusters, const Frame& frame) {
  for (const Cluster& cluster : clusters) {
    if (lives_.size() >= kMostObjects) return;
    const bool part_of_another = std::any_of(lives_.begin(), lives_.end(), [&](const Life& life) {
      return belongs(cluster, life, frame);
    });
    if (part_of_another || !cluster.is_coherent()) continue;
    Life life = std::move(spare_.back());
    spare_.pop_back();
    life.object = MovingObject();
    life.object.id = next_id_++;
    life.frames_seen = 0;
    life.resting_s = 0;
    life.claimed = false;
    life.group.assign(cluster.group.begin(), cluster.group.end());
    see(life, cluster, frame);
    life.group.clear();
    lives_.push_back(std::move(life));
  }
}

void ObjectTracker::see(Life& life, const Cluster& cluster, const Frame& frame) {
  MovingObject& object = life.object;
  const Eigen::Vector2d behind_px = frame.background->model.displacement_px(cluster.position_px);
  object.position_px = cluster.position_px + behind_px + cluster.moved_px;
  object.size_px = cluster.size_px;
  object.relative_px_s = cluster.moved_px / frame.interval_s;
  object.on_screen_px_s = (behind_px + cluster.moved_px) / frame.interval_s;
  object.growth_1_s = cluster.motion.growth() / frame.interval_s;
  object.roll_rad_s = cluster.motion.roll_rad() / frame.interval_s;
  object.model = cluster.motion.kind;
  object.tracks = static_cast<int>(cluster.members.size());
  object.noise_px_s = frame.sigma_px / std::sqrt(object.tracks) / frame.interval_s;
  life.track_ids.clear();
  const auto keep = [&](int i) { life.track_ids.push_back(relative_[static_cast<size_t>(i)].id); };
  std::for_each(life.group.begin(), life.group.end(), keep);
  std::for_each(cluster.members.begin(), cluster.members.end(), keep);
  std::sort(life.track_ids.begin(), life.track_ids.end());
  ++life.frames_seen;
  life.unseen_s = 0;
}

/// One frame more: where it is now, or that it is out of sight.
void ObjectTracker::live(Life& life, const Frame& frame) {
  // Those of its tracks that do not stand out now may be slow, not gone.
  Indices tracks(life.group.begin(), life.group.end(), memory_.resource());
  for (size_t i = 0; i < relative_.size(); ++i) {
    if (owns(life.track_ids, relative_[i].id)) tracks.push_back(static_cast<int>(i));
  }
  std::sort(tracks.begin(), tracks.end());
  tracks.erase(std::unique(tracks.begin(), tracks.end()), tracks.end());

  MovingObject& object = life.object;
  const Cluster cluster = finder_.describe(relative_, std::move(tracks), frame.sigma_px);
  if (cluster.members.size() >= kLeastToSee) {
    see(life, cluster, frame);
  } else {
    object.tracks = 0;
    object.position_px += object.on_screen_px_s * frame.interval_s;
    life.unseen_s += frame.interval_s;
  }
  life.resting_s = life.claimed || object.tracks == 0 ? 0 : life.resting_s + frame.interval_s;
  const double felt_px_s = life.unseen_s > kCoast_s ? 0 : object.relative_px_s.norm();
  const double share = 1 - std::exp(-frame.interval_s / MovingObject::kProminence_s);
  object.prominence += share * (object.area_px2() * felt_px_s - object.prominence);
  life.group.clear();
  life.claimed = false;
}

template <typename Dead>
void ObjectTracker::drop(Dead&& dead) {
  size_t kept = 0;
  for (size_t i = 0; i < lives_.size(); ++i) {
    if (dead(lives_[i])) {
      spare_.push_back(std::move(lives_[i]));
    } else {
      if (kept < i) lives_[kept] = std::move(lives_[i]);
      ++kept;
    }
  }
  lives_.resize(kept);
}

const std::vector<MovingObject>& ObjectTracker::update(const std::vector<Displacement>& points,
                                                       const Background& background, int width,
                                                       int height, double interval_s) {
  const Frame frame{&background, interval_s, kReach * std::min(width, height), background.sigma_px};
  memory_.release();
  Clusters clusters = find_relative(points, frame);
  claim_by_tracks(clusters, frame);
  claim_by_place(clusters, frame);
  drop([](const Life& life) { return life.frames_seen < kBornAfter && !life.claimed; });
  for (Life& life : lives_) live(life, frame);
  drop([](const Life& life) { return life.unseen_s > kForgotten_s || life.resting_s > kAtRest_s; });
  bear(clusters, frame);

  objects_.clear();
  for (const Life& life : lives_) {
    if (life.frames_seen < kBornAfter) continue;
    objects_.push_back(life.object);
    if (life.unseen_s <= kCoast_s) continue;
    objects_.back().relative_px_s.setZero();
    objects_.back().on_screen_px_s.setZero();
    objects_.back().growth_1_s = 0;
    objects_.back().roll_rad_s = 0;
  }
  return objects_;
}

}  // namespace spidar
