// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/skew/measure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/track/track_format.h"
#include "spidar/realtime/monotonic.h"
#include "tests/bench/skew/player.h"
#include "tests/support/temporary_folder.h"

namespace spidar::bench {
namespace {

struct FeltFrame {
  int64_t running_ns;
  int64_t monotonic_ns;  ///< at which the tick began
};

/// The ticks at which the loop came to another frame.
class FeltFrames {
 public:
  /// At this rate samples of a track are so far apart in running time.
  explicit FeltFrames(const Scenario& scenario)
      : track_(scenario.track),
        step_ns_(std::llround(static_cast<double>(kTrackPeriod_ns) / scenario.rate)) {}

  /// Reads the trace of a playback that has ended. Throws std::runtime_error without its columns.
  void read(const std::string& path) {
    std::ifstream trace(path);
    std::string line;
    std::getline(trace, line);
    const std::vector<std::string> names = split(line);
    std::array<size_t, 4> columns{};
    const std::array<std::string, 4> wanted{"playing", "frame_ns", "monotonic_ns", "running_ns"};
    for (size_t i = 0; i < wanted.size(); ++i) {
      const auto found = std::find(names.begin(), names.end(), wanted[i]);
      if (found == names.end()) throw std::runtime_error(path + " has no column " + wanted[i]);
      columns[i] = static_cast<size_t>(found - names.begin());
    }
    while (std::getline(trace, line)) {
      const std::vector<std::string> fields = split(line);
      if (fields.size() < names.size()) continue;
      add(fields[columns[0]] == "1", std::stoll(fields[columns[1]]), std::stoll(fields[columns[2]]),
          std::stoll(fields[columns[3]]));
    }
  }

  const std::vector<FeltFrame>& frames() const { return frames_; }

  /// Of a track, from `begin_ns` on: the first tick that had reached each of these frames.
  std::vector<FeltFrame> reached(const std::vector<ShownFrame>& shown, int64_t begin_ns) const {
    std::vector<FeltFrame> reached;
    size_t tick = 0;
    while (tick < frames_.size() && frames_[tick].monotonic_ns < begin_ns) ++tick;
    for (const ShownFrame& frame : shown) {
      while (tick < frames_.size() && frames_[tick].running_ns < frame.running_ns) ++tick;
      if (tick < frames_.size()) reached.push_back({frame.running_ns, frames_[tick].monotonic_ns});
    }
    return reached;
  }

 private:
  static std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> fields;
    std::istringstream rest(line);
    for (std::string field; std::getline(rest, field, ',');) fields.push_back(field);
    return fields;
  }

  void add(bool playing, int64_t frame_ns, int64_t monotonic_ns, int64_t running_ns) {
    if (!playing) {
      last_frame_ns_ = -1;  // after a seek the same running time is another frame
      return;
    }
    if (track_) {
      // Between samples the force is interpolated: it is that of the tick's own running time.
      const bool has_sample = frame_ns >= 0 && running_ns - frame_ns < step_ns_;
      if (has_sample) frames_.push_back({running_ns, monotonic_ns});
      return;
    }
    if (frame_ns == last_frame_ns_) return;
    last_frame_ns_ = frame_ns;
    if (frame_ns >= 0) frames_.push_back({frame_ns, monotonic_ns});
  }

  const bool track_;
  const int64_t step_ns_;
  int64_t last_frame_ns_ = -1;
  std::vector<FeltFrame> frames_;
};

/// How much faster than CLOCK_MONOTONIC the pipeline's clock ran. A sound card's takes a moment to
/// get going.
double drift_ppm(const std::vector<ShownFrame>& shown) {
  if (shown.size() < 8) return 0;
  const ShownFrame& from = shown[shown.size() / 4];
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
  FeltFrames felt(scenario);
  felt.read(trace);

  const auto is_outside = [&](const ShownFrame& frame) {
    return frame.monotonic_ns < begin_ns || frame.monotonic_ns > end_ns;
  };
  shown.erase(std::remove_if(shown.begin(), shown.end(), is_outside), shown.end());
  result.clock_ppm = drift_ppm(shown);
  std::map<int64_t, int64_t>
      felt_ns;  // CLOCK_MONOTONIC of the first tick of a frame, by running time
  for (const FeltFrame& frame : scenario.track ? felt.reached(shown, begin_ns) : felt.frames()) {
    if (frame.monotonic_ns >= begin_ns) felt_ns.emplace(frame.running_ns, frame.monotonic_ns);
  }
  const auto ms = [](int64_t later_ns, int64_t earlier_ns) {
    return 1e-6 * static_cast<double>(later_ns - earlier_ns);
  };
  for (const ShownFrame& frame : shown) {
    result.picture_ms.push_back(ms(frame.monotonic_ns, frame.due_ns));
    const auto tick = felt_ns.find(frame.running_ns);
    if (tick == felt_ns.end()) continue;
    result.skew_ms.push_back(ms(tick->second, frame.monotonic_ns));
    result.force_ms.push_back(ms(tick->second, frame.due_ns));
  }
  return result;
}

}  // namespace spidar::bench
