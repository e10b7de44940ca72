// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What is to be felt of an address that a player states.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

namespace spidar::follow {

struct FilmPlan {
  std::string name;      ///< for people: the path of a file, any other address as it is
  std::string refused;   ///< why nothing of it is felt; empty: it is a film
  std::string uri;       ///< of the film
  std::string track;     ///< file with its haptic track, or its script; empty: the film is analysed
  int64_t later_ns = 0;  ///< how much later the film shows the pictures of its track
  int64_t frame_ns = 0;  ///< between two pictures; 0 if it is not known
  std::string remark;    ///< to be printed when the film is followed: why its track is not felt
};

/// The path that a player means by a path, by a URI, or by a URI whose '#' and '%' are not escaped,
/// as some players write them. Empty if it is no file of this machine.
std::string path_of(const std::string& address);

/// Reads from the film what has to be known of it. Only regular files are opened; http and https
/// are accepted unread. May wait for a disk, so it must not run in a main loop.
FilmPlan plan_film(const std::string& address, const std::atomic<bool>* stopped = nullptr);

}  // namespace spidar::follow
