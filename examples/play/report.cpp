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

/// Reasons of a smaller fraction of the frames are left out.
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

/// Returns the rows in the order of their size.
template <typename Row>
std::vector<double> forces_N(const std::vector<Row>& rows) {
  std::vector<double> sizes;
  for (const Row& row : rows) {
    sizes.push_back(std::hypot(row.force_N[0], row.force_N[1], row.force_N[2]));
  }
  std::sort(sizes.begin(), sizes.end());
  return sizes;
}

/// The number of frames, with repetitions, by the word of their reason.
std::map<std::string, size_t> counted_reasons(const Record& record) {
  std::map<std::string, size_t> reasons;
  for (const auto& [time_s, word] : record.reasons()) ++reasons[word];
  return reasons;
}

std::string force_line(const Record& record) {
  const bool has_device = !record.devices().empty();
  const auto sizes_N = has_device ? forces_N(record.devices()) : forces_N(record.frames());
  if (sizes_N.empty()) return "Force: none, because no device ran.\n";
  return text_of("Force%s: %.2f N in the median, %.2f N at most.\n",
                 has_device ? " at the grip" : " that is wanted", sizes_N[sizes_N.size() / 2],
                 sizes_N.back());
}

std::string time_line(const GstStructure* stats) {
  const double median_ms = ms_in(stats, "skew-median");
  // The median is zero when no frame has reached a device.
  if (!(median_ms > 0)) return "In time: not measured, because no frame reached a device.\n";
  return text_of(
      "In time: a force comes %.2f ms after its frame in the median, %.2f ms at 99 %%.\n",
      median_ms, ms_in(stats, "skew-p99"));
}

std::string analysis_line(const Record& record, const GstStructure* stats) {
  if (!record.track().empty()) {
    return "Analysis: none, because the force is that of the haptic track " + record.track() +
           ".\n";
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
  const uint64_t ticks = count_in(stats, "ticks");
  if (const uint64_t n = count_in(stats, "overruns")) {
    add(text_of("%" PRIu64 " of %" PRIu64 " ticks came late", n, ticks));
  }
  if (const uint64_t n = count_in(stats, "missed-ticks")) {
    add(text_of("%" PRIu64 " ticks were left out", n));
  }
  if (const uint64_t n = count_in(stats, "gap-ticks")) {
    add(text_of("no force for %.2f s in all, because no frame came in time",
                1e-3 * static_cast<double>(n)));
  }
  int string = -1;
  if (gst_structure_get_int(stats, "faulty-string", &string) && string >= 0) {
    add(text_of("string %d is slack, broken or without encoder", string));
  }
  const std::string fault = word_in(stats, "pose-fault");
  if (!fault.empty() && fault != "none") add("the pose is not known: " + fault);
  if (const uint64_t n = count_in(stats, "refused-wrenches")) {
    add(text_of("the force of %" PRIu64 " frames was not rendered", n));
  }
  return "Device: " + device + ", " + (problems.empty() ? "no problems found" : problems) + ".\n";
}

/// How many of the frames were felt, and why the others were not, the most frequent reason first.
std::string felt_text(const Record& record) {
  const auto counted = counted_reasons(record);
  const size_t all = record.reasons().size();
  std::vector<std::pair<std::string, size_t>> reasons(counted.begin(), counted.end());
  std::stable_sort(reasons.begin(), reasons.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  if (reasons.size() == 1 && reasons[0].first != kFelt) {
    return "Nothing was felt: " + record.sentence(reasons[0].first) + "\n";
  }
  if (all == 0) return {};
  std::string text;
  for (const auto& [word, count] : reasons) {
    if (word == kFelt || static_cast<double>(count) < kWorthALine * static_cast<double>(all)) {
      continue;
    }
    text += "  " + percent(count, all) + "  " + record.sentence(word) + "\n";
  }
  const auto felt = counted.find(kFelt);
  return "Felt: " + percent(felt == counted.end() ? 0 : felt->second, all) + " of the frames" +
         (text.empty() ? ".\n" : "; the others:\n" + text);
}

}  // namespace

std::string report_text(const Record& record, const GstStructure* stats, uint64_t shown) {
  const auto [begin_s, end_s] = record.span_s();
  // Both counts include the frames before a seek, at which the record begins again.
  const uint64_t analysed = count_in(stats, "frames");
  const std::string of_them =
      record.track().empty() ? text_of("%" PRIu64 " analysed of ", analysed) : "";
  return text_of("Video: %.1f s, %s%" PRIu64 " frames shown.\n", end_s - begin_s, of_them.c_str(),
                 shown) +
         force_line(record) + time_line(stats) + analysis_line(record, stats) + device_line(stats) +
         felt_text(record);
}

std::string progress_line(double time_s, const FrameRow* frame) {
  constexpr int kBar = 20;
  constexpr double kFullBar_N = 3.0;
  char line[160];
  if (!frame) {
    std::snprintf(line, sizeof line, "%7.1f s", time_s);
    return line;
  }
  const auto& force_N = frame->force_N;
  const double size_N = std::hypot(force_N[0], force_N[1], force_N[2]);
  const int filled = std::min(kBar, static_cast<int>(std::lround(kBar * size_N / kFullBar_N)));
  char speed[24] = "";  // a track contains no speeds
  if (frame->is_measured) {
    std::snprintf(speed, sizeof speed, "  %6.0f px/s",
                  std::hypot(frame->velocity_px_s[0], frame->velocity_px_s[1]));
  }
  std::snprintf(line, sizeof line, "%7.1f s%s  %5.2f N [%-*s] x %+.2f y %+.2f  %s", time_s, speed,
                size_N, kBar, std::string(static_cast<size_t>(filled), '=').c_str(), force_N[0],
                force_N[1], frame->reason == kFelt ? "felt" : frame->reason.c_str());
  return line;
}
