/// A grey picture that belongs to somebody else.
#pragma once

#include <cstddef>
#include <cstdint>

namespace spidar {

/// 8-bit luma, `height` rows of `width` pixels, rows `stride_bytes` apart. Never owns the memory.
struct ImageView {
  const uint8_t* data = nullptr;
  int width = 0;
  int height = 0;
  ptrdiff_t stride_bytes = 0;
};

}  // namespace spidar
