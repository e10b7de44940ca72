// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How far drivers have been tested.
#pragma once

namespace spidar {

/// How far a driver has been tested.
enum class Trial {
  kHardware,  ///< on the real board
  kEmulated,  ///< on an emulated board that follows the published description
  kInferred,  ///< parts of it are inferred, which an emulation cannot confirm
};

/// "tried on hardware", "emulated", "inferred".
inline const char* to_string(Trial trial) noexcept {
  switch (trial) {
    case Trial::kHardware:
      return "tried on hardware";
    case Trial::kEmulated:
      return "emulated";
    case Trial::kInferred:
      return "inferred";
  }
  return "unknown";
}

}  // namespace spidar
