// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Force-feedback devices that there are.
#pragma once

#include <string>
#include <vector>

#include "core/api.h"

namespace spidar {

struct EvdevInfo {
  std::string path;         ///< "/dev/input/event5"
  std::string name;         ///< as its driver calls it; may be empty
  std::string serial;       ///< empty when it has none
  std::string id;           ///< vendor and product: "046d:c24f"
  bool constant = false;    ///< it gives a force in a direction; else it only rumbles
  bool accessible = false;  ///< this process may open it
};

/// Input devices with FF_CONSTANT, then those with nothing but FF_RUMBLE, by number. What the
/// kernel says of them in /sys/class/input is read; none is opened.
SPIDAR_API std::vector<EvdevInfo> list_force_feedback();

}  // namespace spidar
