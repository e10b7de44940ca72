// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What an element's frames go on to, and what they come from.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include <gst/gst.h>

namespace spidar {

/// A pad that frames pass. `element`: the one they enter by it; null where they leave one, or at
/// the inner side of a ghost pad.
struct DownstreamStep {
  GstPad* pad;
  GstElement* element;
};

/// The pads from an element to another one, with a reference to each.
class DownstreamPath {
 public:
  DownstreamPath() = default;
  ~DownstreamPath();
  DownstreamPath(DownstreamPath&& other) noexcept : steps_(std::exchange(other.steps_, {})) {}
  DownstreamPath& operator=(DownstreamPath&& other) noexcept {
    std::swap(steps_, other.steps_);
    return *this;
  }

  const std::vector<DownstreamStep>& steps() const { return steps_; }
  /// Takes both references.
  void add(GstPad* pad, GstElement* element) { steps_.push_back({pad, element}); }
  void drop_last();

 private:
  std::vector<DownstreamStep> steps_;
};

/// The way from `element` to the first one behind it, through bins, for which `wanted` says yes;
/// empty without such. Links that change meanwhile end the search.
DownstreamPath find_path_downstream(GstElement* element,
                                    const std::function<bool(GstElement*)>& wanted);

/// The same, from a source pad.
DownstreamPath find_path_downstream(GstPad* source, const std::function<bool(GstElement*)>& wanted);

/// Whether `wanted` says yes for an element before `sink`, through bins, on any branch.
bool is_upstream(GstPad* sink, const std::function<bool(GstElement*)>& wanted);

}  // namespace spidar
