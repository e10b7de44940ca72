// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/choice/feel_edit.h"

#include <algorithm>

namespace spidar {
namespace {

FeelRule rule_of(const FeelEdit& edit) {
  FeelRule rule;
  rule.from_ns = edit.from_ns;
  rule.to_ns = edit.to_ns;
  rule.kind = FeelKind::kObjectAt;
  rule.place = *edit.place;
  return rule;
}

}  // namespace

std::vector<FeelRule> edited(const std::vector<FeelRule>& rules, const FeelEdit& edit) {
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
  if (edit.place) result.push_back(rule_of(edit));
  std::sort(result.begin(), result.end(),
            [](const FeelRule& a, const FeelRule& b) { return a.from_ns < b.from_ns; });
  return result;
}

}  // namespace spidar
