// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <gst/gst.h>

namespace spidar {

/// The debug category with the name of the element's factory. For files that several elements
/// share:
///
///     #undef GST_CAT_DEFAULT  // of another file, where several are compiled as one
///     #define GST_CAT_DEFAULT spidar::category_of(element)
inline GstDebugCategory* category_of(GstElement* element) {
  GstElementFactory* const factory = gst_element_get_factory(element);
  GstDebugCategory* category = nullptr;
  GST_DEBUG_CATEGORY_GET(category, factory ? GST_OBJECT_NAME(factory) : "");
  return category;
}

}  // namespace spidar
