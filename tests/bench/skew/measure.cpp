// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/skew/measure.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "spidar/realtime/monotonic.h"
#include "tests/support/temporary_folder.h"

namespace spidar::bench {
namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream rest(line);
  for (std::string field; std::getline(rest, field, ',');) fields.push_back(field);
  return fields;
}

/// Of a playback that has ended, from `begin_ns` on: CLOCK_MONOTONIC of the first tick of each
/// frame, by its running time.
std::map<int64_t, int64_t> read_ticks(const std::string& path, int64_t begin_ns) {
  std::ifstream trace(path);
  std::string line;
  std::getline(trace, line);
  const std::vector<std::string> names = split(line);
  std::array<size_t, 3> columns{};
  const std::array<std::string, 3> wanted{"playing", "frame_ns", "monotonic_ns"};
  for (size_t i = 0; i < wanted.size(); ++i) {
    const auto found = std::find(names.begin(), names.end(), wanted[i]);
    if (found == names.end()) throw std::runtime_error(path + " has no column " + wanted[i]);
    columns[i] = static_cast<size_t>(found - names.begin());
  }
  std::map<int64_t, int64_t> ticks;
  while (std::getline(trace, line)) {
    const std::vector<std::string> fields = split(line);
    if (fields.size() < names.size() || fields[columns[0]] != "1") continue;
    const int64_t frame_ns = std::stoll(fields[columns[1]]);
    const int64_t monotonic_ns = std::stoll(fields[columns[2]]);
    // Before a seek, the same running time was another frame.
    if (frame_ns >= 0 && monotonic_ns >= begin_ns) ticks.emplace(frame_ns, monotonic_ns);
  }
  return ticks;
}

double drift_ppm(const std::vector<ShownFrame>& shown) {
  if (shown.size() < 8) return 0;
  const ShownFrame& from = shown.front();
  const ShownFrame& to = shown.back();
  const auto running_ns = static_cast<double>(to.running_ns - from.running_ns);
  return 1e6 * (running_ns / static_cast<double>(to.due_ns - from.due_ns) - 1);
}

}  // namespace

Measurement measure(const Scenario& scenario, const std::string& clip, double seconds) {
  constexpr double kLongest_s = 0.3;  // the force of what is shown last has so long to come
  const test::TemporaryFolder folder;
  const std::string trace = folder.path / "haptic.csv";
  std::vector<ShownFrame> shown;
  shown.reserve(size_t{1} << 16);
  Player player(scenario, clip, trace, [&](const ShownFrame& frame) { shown.push_back(frame); });

  Measurement result;
  const int64_t begin_ns = player.start();
  player.play_for(seconds);
  const int64_t end_ns = monotonic_now_ns();
  player.play_for(kLongest_s);
  result.dropped = player.dropped();
  result.scheduling = player.scheduling();
  player.stop();

  const auto is_outside = [&](const ShownFrame& frame) {
    return frame.monotonic_ns < begin_ns || frame.monotonic_ns > end_ns;
  };
  shown.erase(std::remove_if(shown.begin(), shown.end(), is_outside), shown.end());
  result.shown = shown.size();
  result.clock_ppm = drift_ppm(shown);
  const std::map<int64_t, int64_t> felt_ns = read_ticks(trace, begin_ns);
  for (const ShownFrame& frame : shown) {
    const auto tick = felt_ns.find(frame.running_ns);
    if (tick == felt_ns.end()) continue;
    result.skew_ms.push_back(1e-6 * static_cast<double>(tick->second - frame.monotonic_ns));
  }
  return result;
}

}  // namespace spidar::bench
