// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Changes to the rules of what is felt, by pointing instead of writing.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/choice/feel_rules.h"

namespace spidar {

/// From one moment of a film to another, one object is felt, or no rule holds.
struct FeelEdit {
  int64_t from_ns = 0, to_ns = 0;
  /// Where the object is at `from_ns`, as in FeelRule; none: no rule holds.
  std::optional<Eigen::Vector2d> place;
};

/// `rules` in order of time, and so is the result. Rules give way to the edit; what is left behind
/// it of a rule about the object at a place goes, too, because nobody knows where the object is
/// then. An edit that does not end after it begins changes nothing.
std::vector<FeelRule> edited(const std::vector<FeelRule>& rules, const FeelEdit& edit);

}  // namespace spidar
