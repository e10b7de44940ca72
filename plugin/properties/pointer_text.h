// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The property `pointer` as it is written.
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "plugin/properties/motion_properties.h"

namespace spidar {

struct Pointer {
  PointerKind kind = PointerKind::kFixed;
  /// Of kFixed; of the others, where they are until the device runs or the mouse moves. (0, 0) is
  /// the top left corner of the picture, (1, 1) its bottom right one.
  Eigen::Vector2d place{0.5, 0.5};
};

/// As it is by default.
constexpr const char* kMiddle = "0.5,0.5";

/// "grip", "mouse", or two numbers from 0 to 1 with a comma between them; nothing for all else.
std::optional<Pointer> parse_pointer(const std::string& text);
/// The inverse.
std::string text_of(const Pointer& pointer);

}  // namespace spidar
