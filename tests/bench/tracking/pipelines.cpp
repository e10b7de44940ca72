// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/tracking/pipelines.h"

namespace spidar::bench {

const std::vector<Pipeline>& pipelines() {
  static const std::vector<Pipeline> all = {
      {"naive", "naive wiring of OpenCV", make_naive},
      {"paper", "motion=mean", [] { return make_paper(10); }},
      {"paper-30", "the same with min-distance=30", [] { return make_paper(30); }},
      {"fast", "motion=object quality=fast", nullptr, FieldPoints::Settings{64, false}},
      {"balanced", "motion=object", nullptr, FieldPoints::Settings{64, true}},
      {"fine", "motion=object quality=fine", nullptr, FieldPoints::Settings{200, true}},
      {"dis", "DIS ultrafast at 480 px", make_dis_ultrafast},
      {"farneback", "Farneback at 480 px", make_farneback},
      {"phase", "phase correlation at 480 px", make_phase_correlation},
  };
  return all;
}

}  // namespace spidar::bench
