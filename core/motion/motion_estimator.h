/// Which motion of the picture is felt.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/api.h"
#include "core/motion/background.h"
#include "core/motion/dominant_object.h"
#include "core/motion/image_motion.h"
#include "core/motion/objects.h"
#include "core/tracking/tracker.h"

namespace spidar {

enum class MotionKind {
  kMean,     ///< mean velocity of all points: the paper's eq. 9–10
  kObject,   ///< the dominant object against the background
  kObjects,  ///< all objects against the background, weighted by their area
  kCamera,   ///< what the camera does
};

/// What the tracks of one frame say.
struct SceneMotion {
  ImageMotion felt;
  /// Of the background; nothing with kMean, which looks at no model.
  std::optional<ModelKind> model;
  /// Of the camera: where the background goes to the left it goes to the right, where the
  /// background grows it goes in. Zero with kMean.
  ImageMotion camera;
  int objects = 0;  ///< that are known, seen or not; 0 with kMean
  /// The same in full, valid until the estimator's next call; null with kMean.
  const Background* background = nullptr;
  const std::vector<MovingObject>* objects_seen = nullptr;
};

/// tracks → motion. Keeps what must be known of the frames before.
class SPIDAR_API MotionEstimator {
 public:
  /// Tracks between two frames of `width` × `height` pixels that are shown `interval_ns` apart, >
  /// 0.
  SceneMotion estimate(MotionKind kind, const std::vector<Track>& tracks, int width, int height,
                       int64_t interval_ns);

  /// A cut, a seek: the next frame has nothing to do with the one before.
  void reset();

 private:
  std::vector<Displacement> points_;
  BackgroundEstimator background_;
  ObjectTracker objects_;
  DominantObject dominant_;
};

}  // namespace spidar
