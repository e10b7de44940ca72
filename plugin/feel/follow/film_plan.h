// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

namespace spidar::follow {

struct FilmPlan {
  std::string name;      ///< for people: the path of a file, any other address unchanged
  std::string refused;   ///< why nothing of the address is felt; empty: it is a film
  std::string uri;       ///< of the film
  std::string track;     ///< the haptic track or script of the film; empty: the film is analysed
  int64_t later_ns = 0;  ///< how much later the film shows the pictures of its track
  int64_t frame_ns = 0;  ///< between two pictures; 0 if unknown
  std::string remark;    ///< printed when the film is followed: why its track is not felt
};

/// Returns the path of an address, which is a path, a URI, or a URI whose '#' and '%' are not
/// escaped, as some players write it. Empty if the address is not a file on this machine.
std::string path_of(const std::string& address);

/// Plans what is felt of the film at an address that a player reports. Reads only regular files;
/// accepts http and https unread. May wait for a disk, so must not run in a main loop.
FilmPlan plan_film(const std::string& address, const std::atomic<bool>* stopped = nullptr);

}  // namespace spidar::follow
