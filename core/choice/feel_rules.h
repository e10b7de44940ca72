// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace spidar {

/// A rule, written by a user, that says what is felt of a film, and when. Positions go from (0, 0),
/// the top left corner of the shown picture, to (1, 1).
struct FeelRule {
  enum class Kind { kObjectAt, kLargest, kFurthest, kBox, kRegion, kCamera, kNothing };

  static constexpr int64_t kNoEnd = std::numeric_limits<int64_t>::max();
  static constexpr size_t kLongestName = 63;  ///< bytes

  int line = 0;  ///< in the text, from 1 on
  int64_t from_ns = 0;
  int64_t to_ns = kNoEnd;
  Kind kind = Kind::kNothing;
  /// kObjectAt: where the object is at `from_ns`. kRegion: the corner that is nearer to (0, 0).
  Eigen::Vector2d position{0, 0};
  Eigen::Vector2d far_corner{1, 1};  ///< kRegion
  Eigen::Vector2d direction{0, 0};   ///< kFurthest: of length 1
  /// kBox: the name of the box, zero-terminated; empty for any box. An array, so that copies
  /// allocate nothing.
  std::array<char, kLongestName + 1> name{};
  double gain = 1;  ///< of force and torque, 0 … 10

  bool is_about_objects() const { return kind != Kind::kCamera && kind != Kind::kNothing; }
};

/// An error in the text of rules. The message is "line 3: " and a sentence without a full stop.
class FeelRulesError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Rules in order of time. Where none holds, the setting `motion` decides what is felt.
class FeelRules {
 public:
  /// A rule ends with its line or with a semicolon; a # begins a comment:
  ///
  ///     [FROM-[TO]] WHAT [gain G]
  ///
  /// Times are positions in the film, as 12.5, 0:12 or 1:02:03; without them, the rule holds for
  /// the whole film. WHAT is one of: object at X,Y; largest; leftmost; rightmost; topmost;
  /// bottommost; box [NAME]; region X,Y to X,Y; camera; nothing. A NAME of several words is in
  /// quotes. Throws FeelRulesError, also when there is no rule.
  explicit FeelRules(std::string_view text);

  const std::vector<FeelRule>& rules() const { return rules_; }
  /// Returns the rule that holds at `stream_ns`, or null.
  const FeelRule* at(int64_t stream_ns) const;
  /// Whether any rule refers to boxes that come with the frames.
  bool has_boxes() const;
  /// Returns the rules on one line, in canonical form.
  std::string text() const;

 private:
  std::vector<FeelRule> rules_;
};

std::string rule_text(const FeelRule& rule);
/// A time as rules write it: "0:12" or "1:02:03.5".
std::string time_text(int64_t ns);
/// A position as rules write it: "0.31,0.62".
std::string position_text(const Eigen::Vector2d& position);

/// An edit of the rules: between two times of the film, one object is felt, or no rule holds.
struct FeelEdit {
  int64_t from_ns = 0, to_ns = 0;
  /// Where the object is at `from_ns`, as in FeelRule; none: no rule holds.
  std::optional<Eigen::Vector2d> position;
};

/// Applies `edit` to `rules`, which are sorted by time, and returns the sorted result. Overlapping
/// rules are shortened or split. Of a kObjectAt rule, the part after the edit is dropped too,
/// because the object may then be elsewhere. An edit whose end is not after its begin changes
/// nothing.
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
    if (is_later || rule.kind != FeelRule::Kind::kObjectAt) result.push_back(after);
  }
  if (edit.position) {
    FeelRule rule;
    rule.from_ns = edit.from_ns;
    rule.to_ns = edit.to_ns;
    rule.kind = FeelRule::Kind::kObjectAt;
    rule.position = *edit.position;
    result.push_back(rule);
  }
  std::sort(result.begin(), result.end(),
            [](const FeelRule& a, const FeelRule& b) { return a.from_ns < b.from_ns; });
  return result;
}

}  // namespace spidar
