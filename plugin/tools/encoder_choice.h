// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Encoders, of which not all are installed.
#pragma once

#include <gst/gst.h>

#include "plugin/gobject/ref.h"

namespace spidar::tools {

struct Encoder {
  const char* element;
  const char* line;  ///< of elements, for gst_parse_launch()
};

/// The line of the first one that is installed; null when none is.
template <size_t kCount>
const char* first_installed(const Encoder (&encoders)[kCount]) {
  for (const Encoder& encoder : encoders) {
    const Ref<GstElementFactory> factory(gst_element_factory_find(encoder.element));
    if (factory) return encoder.line;
  }
  return nullptr;
}

}  // namespace spidar::tools
