// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What is to be felt of an address that a player tells.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

namespace spidar::follow {

struct FilmPlan {
  std::string name;      ///< for people: the path of a file, another address as it is
  std::string refused;   ///< why nothing of it is felt; empty: it is a film
  std::string uri;       ///< of the film
  std::string track;     ///< file with its haptic track, or its script; empty: it is analysed
  int64_t later_ns = 0;  ///< how much later the film shows the pictures of its track
  int64_t frame_ns = 0;  ///< between two pictures; 0 if it is not known
  std::string remark;    ///< to be said when it is followed: why its track is not felt
};

/// The path that a player means: of a URI, of one whose '#' and '%' are not escaped, as some
/// players tell them, or of a path. Empty if it is no file of this machine.
std::string path_of(const std::string& address);

/// Reads from the film what has to be known of it: nothing else is opened than regular files, and
/// http and https, which are not looked at. May wait for a disk: not for a main loop.
FilmPlan plan_film(const std::string& address, const std::atomic<bool>* stopped = nullptr);

}  // namespace spidar::follow
