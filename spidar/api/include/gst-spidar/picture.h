// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// \file
/// Pictures in memory of the caller.
#pragma once

#include <cstddef>
#include <cstdint>

namespace gst_spidar {
inline namespace v0 {

/// A grey picture: `height` rows of `width` bytes, 0 black and 255 white. The caller owns the
/// memory; a call only reads it, and only until the call returns.
struct GreyPicture {
  const std::uint8_t* data = nullptr;  ///< first pixel of the top row
  int width = 0;                       ///< px, at least 16
  int height = 0;                      ///< px, at least 16
  std::ptrdiff_t stride = 0;           ///< bytes from one row to the next, at least `width`
};

}  // namespace v0
}  // namespace gst_spidar
