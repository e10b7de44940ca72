// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a window looks at.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/choice/feel_edit.h"
#include "plugin/window/model/window_model.h"

namespace spidar {

/// Called on the window thread only.
class WindowSource {
 public:
  virtual ~WindowSource() = default;

  /// False when there is nothing to look at any more.
  virtual bool read(ElementState& state) = 0;
  /// Sets a property; a value that is out of range is brought into it.
  virtual void set(const std::string& setting, double value) = 0;
  /// Where the hand of the simulated device goes, device frame; nothing: it lets go.
  virtual void lead_hand(const std::optional<Eigen::Vector3d>& to_m) = 0;
  /// The object at this place of the frame, a share of its visible part, is felt alone; nothing:
  /// what the properties say is.
  virtual void choose(const std::optional<Eigen::Vector2d>& place) = 0;
  /// Changes the rules in the file of `feel`, or else in the one beside the file `film`; from then
  /// on they hold. Returns what was done or why not, as a sentence.
  struct Saved {
    bool is_done = false;
    std::string what;
  };
  virtual Saved save(const std::string& film, const std::vector<FeelEdit>& edits) = 0;
  /// The window cannot be opened or goes on no more: `what` happened, `advice` to do.
  virtual void warn(const std::string& what, const std::string& advice) = 0;
  /// The user has closed the window.
  virtual void closed() = 0;
};

}  // namespace spidar
