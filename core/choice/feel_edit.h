// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Changes to the rules of what is felt, by pointing instead of writing.
#pragma once

#include <algorithm>
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
  std::optional<Eigen::Vector2d> position;
};

/// `rules` in order of time, and so is the result. Rules give way to the edit; what is left behind
/// it of a rule about the object at a position goes, too, because nobody knows where the object is
/// then. An edit that does not end after it begins changes nothing.
inline std::vector<FeelRule> edited(const std::vector<FeelRule>& rules, const FeelEdit& edit) {
  if (edit.to_ns <= edit.from_ns) return rules;
  std::vector<FeelRule> result;
  for (const FeelRule& rule : rules) {
    FeelRule before = rule, after = rule;
    before.to_ns = std::min(rule.to_ns, edit.from_ns);
    after.from_ns = std::max(rule.from_ns, edit.to_ns);
    const bool is_later = rule.from_ns >= edit.to_ns;
    if (before.from_ns < before.to_ns) result.push_back(before);
    if (after.from_ns >= after.to_ns) continue;
    if (is_later || rule.kind != FeelKind::kObjectAt) result.push_back(after);
  }
  if (edit.position) {
    FeelRule rule;
    rule.from_ns = edit.from_ns;
    rule.to_ns = edit.to_ns;
    rule.kind = FeelKind::kObjectAt;
    rule.position = *edit.position;
    result.push_back(rule);
  }
  std::sort(result.begin(), result.end(),
            [](const FeelRule& a, const FeelRule& b) { return a.from_ns < b.from_ns; });
  return result;
}

}  // namespace spidar
