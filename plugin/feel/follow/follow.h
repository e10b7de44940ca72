// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <string>
#include <vector>

namespace spidar::follow {

/// Runs spidar-feel --follow: renders the force of the film that a player without GStreamer plays,
/// until it is interrupted. `name` is that of a player in MPRIS, such as "vlc"; empty: the one that
/// plays. `properties` are those of spidarmotion, NAME=VALUE. Returns the exit status.
int run(const std::string& name, const std::vector<std::string>& properties);

}  // namespace spidar::follow
