// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What is felt of a film, and when, in the words of a person.
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

/// One line. Places go from (0, 0), the top left corner of the picture as it is shown, to (1, 1).
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
  /// kBox: what the box is called, up to a zero; empty when any is meant. Copies allocate nothing.
  std::array<char, kLongestName + 1> name{};
  double gain = 1;  ///< of force and torque, 0 … 10

  bool is_about_objects() const { return kind != Kind::kCamera && kind != Kind::kNothing; }
};

/// Begins with "line 3: " and is a sentence without a full stop.
class FeelRulesError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Ordered by time; outside of all of them, what `motion` says is felt.
class FeelRules {
 public:
  /// A rule is a line, or ends with a semicolon; what follows a # is a remark:
  ///
  ///     [FROM-[TO]] WHAT [gain G]
  ///
  /// Times are of the film, as 12.5, 0:12 or 1:02:03; without them, all of it is meant. WHAT is one
  /// of: object at X,Y; largest; leftmost; rightmost; topmost; bottommost; box [NAME]; region X,Y
  /// to X,Y; camera; nothing. A NAME of several words is in quotes. Throws FeelRulesError, also
  /// when there is no rule.
  explicit FeelRules(std::string_view text);

  const std::vector<FeelRule>& rules() const { return rules_; }
  /// The rule of this moment; null when there is none.
  const FeelRule* at(int64_t stream_ns) const;
  /// Whether a rule means boxes that come with the frames.
  bool has_boxes() const;
  /// The rules in one line, in the same form however they were typed.
  std::string text() const;

 private:
  std::vector<FeelRule> rules_;
};

/// One rule, as FeelRules::text() has it.
std::string rule_text(const FeelRule& rule);
/// "0:12" or "1:02:03.5", as rules have it.
std::string time_text(int64_t ns);
/// "0.31,0.62".
std::string position_text(const Eigen::Vector2d& position);

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
