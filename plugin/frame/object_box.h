// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <string>

namespace spidar {

/// In pixels of the frame that has it; it may lie partly outside.
struct ObjectBox {
  std::string name;  ///< of what is in it, "face"
  double x, y, width, height;
};

/// The name of our objects.
constexpr const char* kObjectName = "spidar-object";

}  // namespace spidar
