// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a window looks at.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "plugin/window/view/messages.h"

namespace spidar {

/// Called on the thread of the Window only. messages.h says what is asked for.
class WindowSource {
 public:
  virtual ~WindowSource() = default;

  /// Does nothing when there is nothing to look at any more.
  virtual void read(ElementState& state) = 0;
  virtual void set(const std::string& setting, double value) = 0;
  virtual void lead_hand(const std::optional<Eigen::Vector3d>& to_m) = 0;
  virtual void choose(const std::optional<Eigen::Vector2d>& place) = 0;
  /// From then on the rules hold.
  virtual ChoicesSaved save(const std::string& film, const std::vector<FeelEdit>& edits) = 0;
  /// The window cannot be opened or goes on no more: `what` happened, `advice` to do.
  virtual void warn(const std::string& what, const std::string& advice) = 0;
  /// The window is gone, and not because close was called.
  virtual void closed() = 0;
};

}  // namespace spidar
