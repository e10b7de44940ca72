// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <filesystem>
#include <string>
#include <vector>

#include "plugin/tools/spidartrack_commands.h"
#include "plugin/tools/track_samples.h"
#include "spidar/tools/command_line.h"

namespace spidar {

int convert_track(const ConvertOptions& options) {
  const std::string& to = options.to;
  std::error_code none;
  if (std::filesystem::equivalent(options.from, to, none)) {
    throw UsageError(to + ": is to be another file than " + options.from);
  }
  if (options.tolerance && !ends_with(to, ".hjif")) {
    throw UsageError("--tolerance is for .hjif, not for " + to);
  }
  TrackCondition condition;
  const std::vector<TrackSample> samples = load_track(options.from, &condition);
  expect_own_track(condition);
  save_track(to, samples, {options.tolerance, condition.notes});
  return kDone;
}

}  // namespace spidar
