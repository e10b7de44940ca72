// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/tracking/pipelines.h"

namespace spidar::bench {

const std::vector<Pipeline>& pipelines() {
  static const std::vector<Pipeline> all = {
      {"naive", "naive wiring of OpenCV", make_naive},
      {"paper", "motion=mean", make_paper},
      {"object", "motion=object", nullptr},
      {"dis", "DIS ultrafast at 480 px", make_dis_ultrafast},
  };
  return all;
}

}  // namespace spidar::bench
