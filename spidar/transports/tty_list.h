// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Lists serial lines.
#pragma once

#include <string>
#include <vector>

namespace spidar {

struct TtyLine {
  std::string path;  ///< "/dev/ttyUSB0"
  bool named =
      false;  ///< "/dev/spidar…": a udev rule declares that motor boards are connected to it
};

/// Returns the lines of USB adapters (ttyUSB…, ttyACM…) and the named ones in `folder`, sorted.
/// Opens none.
std::vector<TtyLine> list_tty_lines(const std::string& folder = "/dev");

}  // namespace spidar
