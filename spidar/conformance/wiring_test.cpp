// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/conformance/wiring_test.h"

#include <algorithm>

namespace spidar {

WiringTest test_wiring(Device& device, const Profile& profile, const Pace& pace,
                       const WiringTestSettings& settings,
                       const std::function<void(const WiringReport&)>& repeat) {
  WiringTest test;
  test.answers = ask_wiring(device, profile, pace, settings);
  for (int tries = 1; test.answers.complete; ++tries) {
    test.report = judge_wiring(profile, test.answers);
    const auto& channels = test.report.channel;
    const bool silent = std::all_of(channels.begin(), channels.end(), [](const WiringChannel& c) {
      return c.motor_string < 0 && !c.unclear;
    });
    if (test.report.understood() || silent || tries == WiringTest::kTries) break;
    std::array<bool, kMaxStrings> doubtful{};
    for (size_t i = 0; i < doubtful.size(); ++i) doubtful[i] = test.report.channel[i].unclear;
    if (std::none_of(doubtful.begin(), doubtful.end(), [](bool d) { return d; }))
      doubtful.fill(true);
    if (repeat) repeat(test.report);
    ask_again(device, profile, pace, settings, doubtful, test.answers);
  }
  return test;
}

std::string unclear_motors(const WiringReport& report) {
  std::string names;
  for (int i = 0; i < report.count; ++i)
    if (report.channel[static_cast<size_t>(i)].unclear)
      names += (names.empty() ? " " : ", ") + std::to_string(i);
  return names;
}

}  // namespace spidar
