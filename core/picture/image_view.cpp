// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/picture/image_view.h"

#include <stdexcept>
#include <string>

namespace spidar {

void require_usable(const ImageView& frame) {
  const LumaSample& sample = frame.sample;
  const bool known =
      (sample.bytes == 1 || sample.bytes == 2) && sample.shift >= 0 && sample.shift <= 8;
  if (!known) {
    throw std::invalid_argument(
        "a pixel of luma has 1 or 2 bytes and a shift of 0 to 8 bits; got " +
        std::to_string(sample.bytes) + " and " + std::to_string(sample.shift));
  }
  if (frame.data && frame.width >= kMinSide_px && frame.height >= kMinSide_px &&
      frame.stride_bytes >= ptrdiff_t{frame.width} * sample.bytes) {
    return;
  }
  throw std::invalid_argument(
      "a frame needs data, at least " + std::to_string(kMinSide_px) + "x" +
      std::to_string(kMinSide_px) + " pixels and a stride of at least a row's bytes; got " +
      (frame.data ? "" : "no data, ") + std::to_string(frame.width) + "x" +
      std::to_string(frame.height) + " with stride " + std::to_string(frame.stride_bytes));
}

}  // namespace spidar
