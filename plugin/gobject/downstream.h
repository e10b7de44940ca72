// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What an element's frames go on to, and what they come from.
#pragma once

#include <functional>
#include <vector>

#include "plugin/gobject/ref.h"

namespace spidar {

/// A pad that frames pass. `element`: the one they enter by it; null where they leave one, or at
/// the inner side of a ghost pad.
struct DownstreamStep {
  Ref<GstPad> pad;
  Ref<GstElement> element;
};

/// The pads from an element to another one.
using DownstreamPath = std::vector<DownstreamStep>;

/// The way from `element` to the first one behind it, through bins, for which `wanted` says yes;
/// empty without such. Links that change meanwhile end the search.
DownstreamPath find_path_downstream(GstElement* element,
                                    const std::function<bool(GstElement*)>& wanted);

/// The same, from a source pad.
DownstreamPath find_path_downstream(GstPad* source, const std::function<bool(GstElement*)>& wanted);

/// Whether `wanted` says yes for an element before `sink`, through bins, on any branch.
bool is_upstream(GstPad* sink, const std::function<bool(GstElement*)>& wanted);

}  // namespace spidar
