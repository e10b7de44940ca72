// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a person wants to know after a playback.
#pragma once

#include <cstdint>
#include <string>

#include "apps/play/session_record.h"

/// What the element's `stats` tell of a playback; fields as in docs/elements/spidarmotion.md.
struct ElementFacts {
  double analysis_ms_median = 0, analysis_ms_max = 0;
  uint64_t track_frames = 0;  ///< played by a haptic track
  std::string device;         ///< empty: none
  std::string device_state;
  std::string pose_trouble = "none";
  uint64_t times_lost = 0;
  uint64_t exchange_errors = 0;
  uint64_t refused_wrenches = 0;
  int faulty_string = -1;
};

/// Five lines: what was played, its force, whether force and picture were in time, how long the
/// analysis took or that a track took its place, and the problems of the device.
std::string summary_text(const SessionRecord::Numbers& numbers, const ElementFacts& facts);
