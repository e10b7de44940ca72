// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Finds the wiring with a hand that may move.
#pragma once

#include <functional>
#include <string>

#include "spidar/conformance/wiring_answers.h"
#include "spidar/conformance/wiring_report.h"
#include "spidar/device.h"
#include "spidar/profiles/profile.h"

namespace spidar {

struct WiringTest {
  /// A hand that moves is unclear in other strings each time, a wrong wire in the same ones.
  static constexpr int kTries = 3;

  WiringAnswers answers;
  WiringReport report;  ///< of these answers; not valid if they are not complete
};

/// ask_wiring() and judge_wiring(). As long as the report is not understood, up to kTries times in
/// all, and something has moved, calls `repeat`, when all tensions are zero, and asks the motors
/// again that are unclear, or all if none is. Throws DeviceError like ask_wiring().
WiringTest test_wiring(Device& device, const Profile& profile, const Pace& pace,
                       const WiringTestSettings& settings,
                       const std::function<void(const WiringReport&)>& repeat = {});

/// Text like " 2, 5": the motors whose answers are unclear.
std::string unclear_motors(const WiringReport& report);

}  // namespace spidar
