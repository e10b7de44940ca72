#include "tests/bench/tracking/pipelines.h"

#include "core/tracking/opencv_tracker.h"
#include "core/tracking/patch_tracker.h"
#include "tests/bench/tracking/peers.h"

namespace spidar::bench {
namespace {

std::unique_ptr<Tracker> make_patch(TrackerQuality quality, int points = 200) {
  TrackerSettings settings;
  settings.quality = quality;
  settings.max_features = points;
  return std::make_unique<PatchTracker>(settings);
}

}  // namespace

const std::vector<Pipeline>& pipelines() {
  static const std::vector<Pipeline> all = {
      {"naive", "naive wiring of OpenCV", false, make_naive},
      {"opencv", "tracker=opencv", true, [] { return std::make_unique<OpenCvTracker>(); }},
      {"fast", "tracker=patch quality=fast", true,
       [] { return make_patch(TrackerQuality::kFast); }},
      {"balanced", "tracker=patch", true, [] { return make_patch(TrackerQuality::kBalanced); }},
      {"fine", "tracker=patch quality=fine", true,
       [] { return make_patch(TrackerQuality::kFine); }},
      {"points-50", "tracker=patch max-features=50", true,
       [] { return make_patch(TrackerQuality::kBalanced, 50); }},
      {"points-400", "tracker=patch max-features=400", true,
       [] { return make_patch(TrackerQuality::kBalanced, 400); }},
      {"dis", "DIS ultrafast at 480 px", true, make_dis_ultrafast},
      {"farneback", "Farneback at 480 px", true, make_farneback},
      {"phase", "phase correlation at 480 px", true, make_phase_correlation},
  };
  return all;
}

}  // namespace spidar::bench
