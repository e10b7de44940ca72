// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/trace_track.h"

#include <array>
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "core/track/track_sampler.h"
#include "plugin/tracks/track_file.h"

namespace spidar {
namespace {

/// One row of CSV: running time, stream time, features, tracked, velocity, force, torque.
constexpr size_t kColumns = 12, kForceColumn = 6;

std::runtime_error wrong_line(const std::string& path, int line, const std::string& what) {
  return std::runtime_error(path + ":" + std::to_string(line) + ": " + what);
}

/// The stream time of a frame that is outside the segment.
constexpr int64_t kNoTime = -1;

/// Why no track can have a frame at `time_ns`; empty if it can. A double holds the times of a CSV
/// file: it may be no number, or be too large for an integer.
std::string wrong_time(double time_ns) {
  if (time_ns >= 0 && time_ns <= static_cast<double>(TrackFile::kLongest_ns)) return {};
  std::ostringstream text;
  text << "the stream time is " << 1e-9 * time_ns << " s, must be from 0 to "
       << TrackFile::kLongest_ns / 1'000'000'000 << " s, which is the longest track";
  return text.str();
}

/// Takes frames and returns the samples between them.
class TraceSampler {
 public:
  TraceSampler() { sampler_.begin(0); }

  void add(int64_t time_ns, const Wrench& wrench, bool repeated, bool restarted) {
    interval_ns_ = last_ns_ < 0 ? 0 : time_ns - last_ns_;
    const int64_t hold_ns = restarted ? 0 : WrenchTimeline::hold_after(interval_ns_);
    sampler_.add({time_ns, hold_ns, wrench, repeated});
    last_ns_ = time_ns;
    take_until(sampler_.settled_ns(INT64_MAX / 4));
  }

  /// Throws std::runtime_error when there was no frame.
  std::vector<TrackSample> finish(const std::string& path) {
    if (last_ns_ < 0) {
      throw std::runtime_error(path +
                               ": is a trace without frames; a film has to be played for it");
    }
    sampler_.add({last_ns_ + interval_ns_, 0, Wrench(), false});
    take_until(last_ns_ + interval_ns_);
    return std::move(samples_);
  }

 private:
  void take_until(int64_t time_ns) {
    while (sampler_.next_ns() < time_ns) samples_.push_back(to_track_sample(sampler_.take()));
  }

  TrackSampler sampler_;
  std::vector<TrackSample> samples_;
  int64_t last_ns_ = -1, interval_ns_ = 0;
};

}  // namespace

std::vector<TrackSample> read_csv_trace(const std::string& path, const std::string& text) {
  std::istringstream rows(text);
  std::string row;
  std::getline(rows, row);
  if (row.rfind("running_time_ns,stream_time_ns,", 0) != 0) {
    throw std::runtime_error(path + ": is no trace of spidarmotion");
  }
  TraceSampler sampler;
  for (int line = 2; std::getline(rows, row); ++line) {
    std::vector<double> cells;
    std::istringstream in(row);
    for (std::string cell; std::getline(in, cell, ',');)
      cells.push_back(std::strtod(cell.c_str(), nullptr));
    if (cells.size() < kColumns) {
      throw wrong_line(path, line, "a row has " + std::to_string(kColumns) + " columns");
    }
    const auto* value = &cells[kForceColumn];
    if (cells[1] == kNoTime) continue;
    const std::string problem = wrong_time(cells[1]);
    if (!problem.empty()) throw wrong_line(path, line, problem);
    sampler.add(static_cast<int64_t>(cells[1]),
                {{value[0], value[1], value[2]}, {value[3], value[4], value[5]}}, false, false);
  }
  return sampler.finish(path);
}

std::vector<TrackSample> read_json_trace(const std::string& path, const std::string& text) {
  std::istringstream lines(text);
  TraceSampler sampler;
  std::string row;
  int line = 0;
  while (std::getline(lines, row)) {
    ++line;
    try {
      const nlohmann::json frame = nlohmann::json::parse(row);
      const nlohmann::json& wrench = frame.at("wrench");
      const auto vector = [&wrench](const char* name) {
        const auto values = wrench.at(name).get<std::array<double, 3>>();
        return Eigen::Vector3d(values[0], values[1], values[2]);
      };
      const auto time_ns = frame.at("stream_time_ns").get<int64_t>();
      if (time_ns == kNoTime) continue;
      const std::string problem = wrong_time(static_cast<double>(time_ns));
      if (!problem.empty()) throw wrong_line(path, line, problem);
      sampler.add(time_ns, {vector("force_N"), vector("torque_Nm")},
                  frame.at("repeated").get<bool>(), frame.at("restarted").get<bool>());
    } catch (const nlohmann::json::exception& error) {
      throw wrong_line(path, line,
                       std::string("is no line of a trace of spidarmotion: ") + error.what());
    }
  }
  if (line == 0) throw std::runtime_error(path + ": is empty, and no trace of spidarmotion");
  return sampler.finish(path);
}

}  // namespace spidar
