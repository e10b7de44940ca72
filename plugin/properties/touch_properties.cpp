// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/properties/touch_properties.h"

namespace spidar {

std::optional<DepthLayout> packed_layout(DepthSource source) {
  switch (source) {
    case DepthSource::kRight:
      return DepthLayout::kRight;
    case DepthSource::kBelow:
      return DepthLayout::kBelow;
    case DepthSource::kMeta:
      break;
  }
  return std::nullopt;
}

}  // namespace spidar
