// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/tracking/pipelines.h"

#include "core/tracking/opencv_tracker.h"
#include "core/tracking/patch_tracker.h"
#include "tests/bench/tracking/peers.h"

namespace spidar::bench {
namespace {

std::unique_ptr<Tracker> make_patch(int points) {
  TrackerSettings settings;
  settings.max_features = points;
  return std::make_unique<PatchTracker>(settings);
}

std::unique_ptr<Tracker> make_opencv(double min_distance_px) {
  TrackerSettings settings;
  settings.min_distance_px = min_distance_px;
  return std::make_unique<OpenCvTracker>(settings);
}

std::unique_ptr<Tracker> make_nothing() {
  return nullptr;
}

}  // namespace

const std::vector<Pipeline>& pipelines() {
  static const std::vector<Pipeline> all = {
      {"naive", "naive wiring of OpenCV", false, make_naive},
      {"opencv", "tracker=opencv", true, [] { return std::make_unique<OpenCvTracker>(); }},
      {"opencv-30", "the same with min-distance=30", true, [] { return make_opencv(30); }},
      {"fast", "motion=object quality=fast", true, make_nothing, FieldPoints::Settings{64, false}},
      {"balanced", "motion=object", true, make_nothing, FieldPoints::Settings{64, true}},
      {"fine", "motion=object quality=fine", true, make_nothing, FieldPoints::Settings{200, true}},
      {"patch", "tracker=patch of motion=mean", true, [] { return make_patch(200); }},
      {"patch-400", "the same with max-features=400", true, [] { return make_patch(400); }},
      {"dis", "DIS ultrafast at 480 px", true, make_dis_ultrafast},
      {"farneback", "Farneback at 480 px", true, make_farneback},
      {"phase", "phase correlation at 480 px", true, make_phase_correlation},
  };
  return all;
}

}  // namespace spidar::bench
