// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a frame shows.
#pragma once

#include <cstdint>

namespace spidar {

/// What a frame shows, compared with the picture before.
enum class PictureKind : uint8_t {
  kFirst,    ///< there is nothing to compare with: the first one, another size, or a cut
  kWaiting,  ///< the same picture, and the motion may go on
  kSame,     ///< the same picture, which is at rest
  kAlike,    ///< the same picture, apart from the noise of coding
  kOther,    ///< another picture
};

/// Whether the picture before is shown again, be it waiting or at rest.
constexpr bool is_again(PictureKind kind) {
  return kind != PictureKind::kFirst && kind != PictureKind::kOther;
}

}  // namespace spidar
