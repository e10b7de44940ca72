// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Exit statuses of the command-line programs, as their manual pages list them.
#pragma once

namespace spidar {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kWrongUsage = 2;
constexpr int kInterrupted = 130;  ///< 128 + SIGINT, as shells report it

}  // namespace spidar
