// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What was felt of a track of six constants, read from the haptic-trace.
#pragma once

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gst/gst.h>
#include <gtest/gtest.h>

#include "core/track/track_format.h"
#include "tests/pipelines/launched.h"
#include "tests/support/tick_watch.h"

namespace spidar::test {

/// Whole steps of 24 bits, different on each axis: 0.6 N and 40 mN m.
constexpr TrackSample kConstant = {0.0625F, -0.03125F, 0.046875F, 0.03125F, -0.015625F, 0.0234375F};

/// One row a millisecond.
struct Row {
  bool interpolated = false;  ///< between two samples
  std::vector<double> wanted, commanded;

  double commanded_N() const { return std::hypot(commanded[0], commanded[1], commanded[2]); }
};

inline std::vector<Row> read_trace(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  std::vector<std::string> names;
  std::istringstream header(line);
  for (std::string name; std::getline(header, name, ',');) names.push_back(name);
  std::vector<Row> rows;
  while (std::getline(file, line)) {
    Row row;
    std::istringstream cells(line);
    std::string cell;
    for (size_t i = 0; std::getline(cells, cell, ','); ++i) {
      const std::string& name = names.at(i);
      if (name == "found") row.interpolated = cell == "interpolated" || cell == "exact";
      if (name.rfind("wanted_", 0) == 0) row.wanted.push_back(std::stod(cell));
      if (name.rfind("commanded_", 0) == 0) row.commanded.push_back(std::stod(cell));
    }
    rows.push_back(row);
  }
  return rows;
}

/// All ticks under watch: no limit is exceeded, no change is a kick, and rest comes in time. Where
/// samples of kConstant were felt, each channel was in its place.
inline std::vector<Row> felt_constant(const std::string& trace) {
  TickWatch().see_trace(trace);
  std::vector<Row> rows = read_trace(trace);
  const Wrench constant = to_wrench(kConstant);
  for (const Row& row : rows) {
    if (!row.interpolated) continue;
    for (size_t axis = 0; axis < kTrackChannels; ++axis) {
      EXPECT_NEAR(row.wanted[axis], constant.stacked()[static_cast<Eigen::Index>(axis)], 1e-6)
          << "channels stay in their places";
    }
  }
  return rows;
}

/// Plays to the end, or to an error.
inline Outcome await_end(GstElement* pipeline) {
  Outcome outcome;
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  GstBus* bus = gst_element_get_bus(pipeline);
  while (!outcome.eos && outcome.error.empty()) {
    GstMessage* message = gst_bus_timed_pop(bus, GST_CLOCK_TIME_NONE);
    take(outcome, message);
    gst_message_unref(message);
  }
  gst_object_unref(bus);
  return outcome;
}

}  // namespace spidar::test
