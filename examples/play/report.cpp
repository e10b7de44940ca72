// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "examples/play/report.h"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>
#include <vector>

#include "core/force/motion_rendering.h"

namespace {

/// Reasons of less than this share of the frames are left out.
constexpr double kWorthALine = 0.005;

template <typename... Values>
std::string text_of(const char* format, Values... values) {
  char text[200];
  std::snprintf(text, sizeof(text), format, values...);
  return text;
}

uint64_t count_in(const GstStructure* stats, const char* name) {
  guint64 value = 0;
  gst_structure_get_uint64(stats, name, &value);
  return value;
}

/// Of a time in ns.
double ms_in(const GstStructure* stats, const char* name) {
  return 1e-6 * static_cast<double>(count_in(stats, name));
}

std::string word_in(const GstStructure* stats, const char* name) {
  const char* const text = gst_structure_get_string(stats, name);
  return text ? text : "";
}

std::string percent(size_t part, size_t all) {
  return text_of("%.1f %%", 100.0 * static_cast<double>(part) / static_cast<double>(all));
}

/// In the order of their size.
template <typename Row>
std::vector<double> forces_N(const std::vector<Row>& rows) {
  std::vector<double> sizes;
  for (const Row& row : rows) {
    sizes.push_back(std::hypot(row.force_N[0], row.force_N[1], row.force_N[2]));
  }
  std::sort(sizes.begin(), sizes.end());
  return sizes;
}

/// Number of frames, also of those that show a picture again, by the word of their reason.
std::map<std::string, size_t> counted_reasons(const Record& record) {
  std::map<std::string, size_t> reasons;
  for (const auto& [time_s, word] : record.reasons()) ++reasons[word];
  return reasons;
}

std::string force_line(const Record& record) {
  const bool has_device = !record.devices().empty();
  const auto sizes_N = has_device ? forces_N(record.devices()) : forces_N(record.frames());
  if (sizes_N.empty()) return "Force: none, because no device ran.\n";
  const auto felt = std::lower_bound(sizes_N.begin(), sizes_N.end(), spidar::kFeltForce_N);
  return text_of("Force%s: %.2f N in the median, %.2f N at most; %s of the time a hand %s it.\n",
                 has_device ? " at the grip" : " that is wanted", sizes_N[sizes_N.size() / 2],
                 sizes_N.back(),
                 percent(static_cast<size_t>(sizes_N.end() - felt), sizes_N.size()).c_str(),
                 has_device ? "feels" : "would feel");
}

std::string time_line(const GstStructure* stats) {
  const double median_ms = ms_in(stats, "skew-median");
  // Zero: no frame has reached a device.
  if (!(median_ms > 0)) return "In time: not measured, because no frame reached a device.\n";
  return text_of(
      "In time: a force comes %.2f ms after its frame in the median, %.2f ms at 99 %%.\n",
      median_ms, ms_in(stats, "skew-p99"));
}

std::string analysis_line(const GstStructure* stats) {
  const uint64_t track_frames = count_in(stats, "track-frames");
  if (track_frames > 0) {
    return text_of("Analysis: none of %" PRIu64 " frames, whose force is that of a haptic track.\n",
                   track_frames);
  }
  return text_of("Analysis: %.2f ms a frame in the median, %.2f ms at most.\n",
                 ms_in(stats, "analysis-median"), ms_in(stats, "analysis-max"));
}

std::string device_line(const GstStructure* stats) {
  const std::string device = word_in(stats, "device");
  if (device.empty()) return "Device: none.\n";
  std::string problems;
  const auto add = [&problems](const std::string& problem) {
    problems += (problems.empty() ? "" : ", ") + problem;
  };
  if (word_in(stats, "device-state") == "lost") add("it does not answer");
  if (const uint64_t n = count_in(stats, "times-lost")) add(text_of("lost %" PRIu64 " times", n));
  if (const uint64_t n = count_in(stats, "exchange-errors")) {
    add(text_of("%" PRIu64 " exchanges failed", n));
  }
  int string = -1;
  if (gst_structure_get_int(stats, "faulty-string", &string) && string >= 0) {
    add(text_of("string %d is slack, broken or without encoder", string));
  }
  const std::string trouble = word_in(stats, "pose-trouble");
  if (!trouble.empty() && trouble != "none") add("the pose is not known: " + trouble);
  if (const uint64_t n = count_in(stats, "refused-wrenches")) {
    add(text_of("the force of %" PRIu64 " frames was not rendered", n));
  }
  return "Device: " + device + ", " + (problems.empty() ? "no problems found" : problems) + ".\n";
}

/// In how many of the frames nothing was felt and why, the most frequent reason first.
std::string unfelt_text(const Record& record) {
  const auto counted = counted_reasons(record);
  const size_t all = record.reasons().size();
  std::vector<std::pair<std::string, size_t>> reasons(counted.begin(), counted.end());
  std::stable_sort(reasons.begin(), reasons.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  if (reasons.size() == 1 && reasons[0].first != kFelt) {
    return "Nothing was felt: " + record.sentence(reasons[0].first) + "\n";
  }
  std::string text;
  size_t unfelt = 0;
  for (const auto& [word, count] : reasons) {
    if (word == kFelt || static_cast<double>(count) < kWorthALine * static_cast<double>(all)) {
      continue;
    }
    unfelt += count;
    text += "  " + percent(count, all) + "  " + record.sentence(word) + "\n";
  }
  if (text.empty()) return text;
  return "Nothing was felt in " + percent(unfelt, all) + " of the frames:\n" + text;
}

}  // namespace

std::string report_text(const Record& record, const GstStructure* stats, uint64_t shown) {
  const uint64_t frames =
      record.frames().size() + record.repeated() + count_in(stats, "track-frames");
  const auto [begin_s, end_s] = record.span_s();
  return text_of("Video: %.1f s, %" PRIu64 " frames, %" PRIu64 " of them shown.\n", end_s - begin_s,
                 frames, shown) +
         force_line(record) + time_line(stats) + analysis_line(stats) + device_line(stats) +
         unfelt_text(record);
}
