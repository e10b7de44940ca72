// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Serial lines that there are.
#pragma once

#include <string>
#include <vector>

#include "core/api.h"

namespace spidar {

struct TtyLine {
  std::string path;    ///< "/dev/ttyUSB0"
  bool named = false;  ///< "/dev/spidar…": somebody's udev rule says that motor boards hang on it
};

/// Those of USB adapters (ttyUSB…, ttyACM…) and the named ones in `folder`, sorted. None is opened.
SPIDAR_API std::vector<TtyLine> list_tty_lines(const std::string& folder = "/dev");

}  // namespace spidar
