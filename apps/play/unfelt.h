// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Explains why nothing was felt.
#pragma once

#include <cstdint>
#include <map>
#include <string>

/// Lines that say in how many of the frames nothing was felt and why, the most frequent reason
/// first, and why nothing was felt in the last second. `frames` counts frames by the nick of their
/// spidar::NoForceReason, `last` is the nick for the last second; unknown nicks are allowed. Frames
/// before the video played do not count. Empty when everything was felt.
std::string unfelt_text(const std::map<std::string, uint64_t>& frames, const std::string& last);
