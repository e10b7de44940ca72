// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <string>
#include <vector>

namespace spidar::screen {

/// Runs spidar-feel --screen: renders the force of what a screen or a window shows, until it is
/// interrupted or the window is closed. For `what` see view_of_x11(). `properties` are those of
/// spidarmotion, NAME=VALUE. Returns the exit status.
int run(const std::string& what, const std::vector<std::string>& properties);

}  // namespace spidar::screen
