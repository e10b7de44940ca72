// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The bins that contain an element, their state, and the elements before and behind it.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include <gst/gst.h>

#include "plugin/gobject/ref.h"

namespace spidar {

/// The bins around `object`, from its parent to the pipeline.
template <typename Object>
std::vector<Ref<GstObject>> bins_around(Object* object) {
  std::vector<Ref<GstObject>> bins;
  for (GstObject* bin = gst_object_get_parent(GST_OBJECT(object)); bin;
       bin = gst_object_get_parent(bin)) {
    bins.emplace_back(bin);
  }
  return bins;
}

/// The outermost bin around `object`, or the object itself when there is no bin.
template <typename Object>
Ref<GstObject> root_of(Object* object) {
  std::vector<Ref<GstObject>> bins = bins_around(object);
  return bins.empty() ? new_ref(GST_OBJECT(object)) : std::move(bins.back());
}

/// A pad on the path of the frames. `element` is the one that they enter through this pad; null if
/// they leave an element there, or at the inner side of a ghost pad.
struct DownstreamStep {
  Ref<GstPad> pad;
  Ref<GstElement> element;
};

/// The pads from `element` to the first one behind it, through bins, for which `wanted` returns
/// true; empty without such a pad. Links that change meanwhile end the search.
std::vector<DownstreamStep> find_path_downstream(GstElement* element,
                                                 const std::function<bool(GstElement*)>& wanted);

std::vector<DownstreamStep> find_path_downstream(GstPad* source,
                                                 const std::function<bool(GstElement*)>& wanted);

/// Whether `wanted` returns true for an element before `sink`, through bins, on any branch.
bool is_upstream(GstPad* sink, const std::function<bool(GstElement*)>& wanted);

/// The state of `element`, or the one to which it is changing.
GstState state_of(GstElement* element);

/// Works like gst_element_sync_state_with_parent(), but repeats when the application has changed
/// the state of `bin` meanwhile. Otherwise `element` could return to a state that the bin has left.
void follow_state(GstElement* bin, GstElement* element);

}  // namespace spidar
