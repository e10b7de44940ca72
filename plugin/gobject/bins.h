// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The bins around an object.
#pragma once

#include <utility>
#include <vector>

#include "plugin/gobject/ref.h"

namespace spidar {

/// From the one that contains it to the pipeline.
template <typename Object>
std::vector<Ref<GstObject>> bins_around(Object* object) {
  std::vector<Ref<GstObject>> bins;
  for (GstObject* bin = gst_object_get_parent(GST_OBJECT(object)); bin;
       bin = gst_object_get_parent(bin))
    bins.emplace_back(bin);
  return bins;
}

/// The outermost of them, or the object itself when it is in none.
template <typename Object>
Ref<GstObject> root_of(Object* object) {
  std::vector<Ref<GstObject>> bins = bins_around(object);
  return bins.empty() ? new_ref(GST_OBJECT(object)) : std::move(bins.back());
}

}  // namespace spidar
