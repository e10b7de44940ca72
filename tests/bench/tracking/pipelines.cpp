#include "tests/bench/tracking/pipelines.h"

#include "core/tracking/opencv_tracker.h"
#include "core/tracking/patch_tracker.h"
#include "tests/bench/tracking/peers.h"

namespace spidar::bench {

const std::vector<Pipeline>& pipelines() {
  static const std::vector<Pipeline> all = {
      {"naive", "naive wiring of OpenCV", false, make_naive},
      {"opencv", "tracker=opencv", true, [] { return std::make_unique<OpenCvTracker>(); }},
      {"patch", "tracker=patch", true, [] { return std::make_unique<PatchTracker>(); }},
      {"dis", "DIS ultrafast at 480 px", true, make_dis_ultrafast},
      {"farneback", "Farneback at 480 px", true, make_farneback},
      {"phase", "phase correlation at 480 px", true, make_phase_correlation},
  };
  return all;
}

}  // namespace spidar::bench
