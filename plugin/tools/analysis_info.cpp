// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/analysis_info.h"

#include <algorithm>
#include <cstdint>
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "core/analysis/measured_frame.h"
#include "plugin/track/motion_sidecar.h"

namespace spidar {
namespace {

struct AnalysisSummary {
  size_t frames = 0;
  size_t with_objects = 0;  ///< of these frames
  size_t objects = 0;       ///< by identity
  double duration_s = 0;
};

AnalysisSummary summarise(const MotionFile& file) {
  AnalysisSummary summary;
  std::set<uint32_t> identities;
  MeasuredFrame frame;
  int64_t end_ns = 0;
  for (size_t i = 0; i < file.size(); ++i) {
    const MotionMoment moment = file.moment(i);
    if (moment.kind != MomentKind::kFrame) continue;
    file.load(i, frame);
    ++summary.frames;
    summary.with_objects += !frame.objects.empty();
    for (const MovingObject& object : frame.objects) identities.insert(object.id);
    end_ns = std::max(end_ns, moment.stream_ns + std::max<int64_t>(0, moment.duration_ns));
  }
  summary.objects = identities.size();
  summary.duration_s = static_cast<double>(end_ns) * 1e-9;
  return summary;
}

}  // namespace

void print_analysis_info(const std::string& path, bool json) {
  try {
    const MotionFile file = read_motion_file(path);
    const AnalysisSummary summary = summarise(file);
    const std::string& settings = file.header().settings;
    if (json) {
      const nlohmann::ordered_json line = {{"analysis", path},
                                           {"frames", summary.frames},
                                           {"duration_s", summary.duration_s},
                                           {"settings", settings},
                                           {"objects", summary.objects},
                                           {"frames_with_objects", summary.with_objects}};
      std::cout << line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
      return;
    }
    std::cout << path << ": analysis of " << summary.frames << " frames, " << summary.duration_s
              << " s, with " << (settings.empty() ? "the defaults" : settings) << '\n'
              << "objects: " << summary.objects << ", in " << summary.with_objects
              << " of the frames\n";
  } catch (const MotionFileError& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
}

}  // namespace spidar
