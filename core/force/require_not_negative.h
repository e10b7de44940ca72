// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// For the settings of this folder.
#pragma once

#include <cmath>
#include <stdexcept>
#include <string>

namespace spidar {

/// Throws std::invalid_argument unless `value` is finite and ≥ 0.
inline void require_not_negative(const char* name, double value) {
  if (std::isfinite(value) && value >= 0) return;
  throw std::invalid_argument(std::string(name) + " must be finite and not negative, got " +
                              std::to_string(value));
}

}  // namespace spidar
