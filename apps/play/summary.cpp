// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "apps/play/summary.h"

#include <cinttypes>
#include <cstdio>

#include "core/analysis/no_force_reason.h"

namespace {

template <typename... Values>
std::string text_of(const char* format, Values... values) {
  char text[200];
  std::snprintf(text, sizeof(text), format, values...);
  return text;
}

std::string force_line(const SessionRecord::Numbers& numbers) {
  const Histogram& force_N = numbers.delivered_N;
  if (force_N.count() == 0 || force_N.max() < spidar::kFeltForce_N || numbers.ticks == 0) {
    return text_of("Force: none of %.2f N, the least that a hand feels, or more.",
                   spidar::kFeltForce_N);
  }
  return text_of(
      "Force: %.2f N in the median, %.2f N at most; %.0f %% of the time a hand feels it.",
      force_N.quantile(0.5), force_N.max(),
      100.0 * static_cast<double>(numbers.felt_ticks) / static_cast<double>(numbers.ticks));
}

std::string time_line(const SessionRecord::Numbers& numbers) {
  if (numbers.skew.size_ms().count() == 0) {
    return "In time: not measured, because no frame with a force was shown.";
  }
  return text_of("In time: force and picture are %.2f ms apart in the median, %.2f ms at 99 %%.",
                 numbers.skew.size_ms().quantile(0.5), numbers.skew.size_ms().quantile(0.99));
}

std::string analysis_line(const ElementFacts& facts) {
  if (facts.track_frames > 0) {
    return text_of("Analysis: none of %" PRIu64 " frames, whose force is that of a haptic track.",
                   facts.track_frames);
  }
  return text_of("Analysis: %.2f ms a frame in the median, %.2f ms at most.",
                 facts.analysis_ms_median, facts.analysis_ms_max);
}

std::string device_line(const ElementFacts& facts) {
  if (facts.device.empty()) return "Device: none.";
  std::string problems;
  const auto add = [&problems](const std::string& problem) {
    problems += (problems.empty() ? "" : ", ") + problem;
  };
  if (facts.device_state == "lost") add("it does not answer");
  if (facts.times_lost > 0) add(text_of("lost %" PRIu64 " times", facts.times_lost));
  if (facts.exchange_errors > 0) {
    add(text_of("%" PRIu64 " exchanges failed", facts.exchange_errors));
  }
  if (facts.faulty_string >= 0) {
    add(text_of("string %d is slack, broken or without encoder", facts.faulty_string));
  }
  if (facts.pose_trouble != "none") add("the pose is not known: " + facts.pose_trouble);
  if (facts.refused_wrenches > 0) {
    add(text_of("the force of %" PRIu64 " frames was not rendered", facts.refused_wrenches));
  }
  return "Device: " + facts.device + ", " + (problems.empty() ? "no problems found" : problems) +
         ".";
}

}  // namespace

std::string summary_text(const SessionRecord::Numbers& numbers, const ElementFacts& facts) {
  return text_of("Video: %.1f s, %" PRIu64 " frames, %" PRIu64 " of them shown.\n",
                 numbers.duration_s, numbers.frames, numbers.shown) +
         force_line(numbers) + "\n" + time_line(numbers) + "\n" + analysis_line(facts) + "\n" +
         device_line(facts) + "\n";
}
