// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/choice/feel_rules.h"

#include <cmath>
#include <cstdio>

#include "core/number_text.h"

namespace spidar {
namespace {

constexpr double kMaxRuleGain = 10;
/// A day, longer than any film. A double represents its nanoseconds exactly.
constexpr double kLongest_s = 86400;
constexpr size_t kMaxQuoted = 40;

struct Direction {
  const char* word;
  double x, y;
};
constexpr Direction kDirections[] = {
    {"leftmost", -1, 0}, {"rightmost", 1, 0}, {"topmost", 0, -1}, {"bottommost", 0, 1}};

constexpr const char* kAllWords =
    "object at X,Y; largest; leftmost; rightmost; topmost; bottommost; box [NAME]; region X,Y to "
    "X,Y; camera; nothing";

[[noreturn]] void wrong(int line, const std::string& what) {
  throw FeelRulesError("line " + std::to_string(line) + ": " + what);
}

/// Quotes `text` for a message: shortened, with ? for each byte that is not printable ASCII.
std::string quote(std::string_view text) {
  std::string shown(text.substr(0, kMaxQuoted));
  for (char& c : shown) {
    if (static_cast<unsigned char>(c) < ' ' || static_cast<unsigned char>(c) > '~') c = '?';
  }
  return '"' + shown + (text.size() > kMaxQuoted ? "…" : "") + '"';
}

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/// Parses S, M:S or H:M:S; only the seconds may have a fraction.
std::optional<int64_t> time_ns(std::string_view text) {
  double seconds = 0;
  for (int parts = 0;; ++parts) {
    const size_t colon = text.find(':');
    const bool is_last = colon == std::string_view::npos;
    const std::optional<double> part = number_of(text.substr(0, colon));
    if (!part || *part < 0 || parts > 2) return std::nullopt;
    if (parts > 0 && *part >= 60) return std::nullopt;
    if (!is_last && *part != std::floor(*part)) return std::nullopt;
    seconds = 60 * seconds + *part;
    if (seconds > kLongest_s) return std::nullopt;
    if (is_last) return std::llround(seconds * 1e9);
    text.remove_prefix(colon + 1);
  }
}

std::optional<Eigen::Vector2d> position_of(std::string_view text) {
  const size_t comma = text.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  const std::optional<double> x = number_of(text.substr(0, comma));
  const std::optional<double> y = number_of(text.substr(comma + 1));
  if (!x || !y || *x < 0 || *x > 1 || *y < 0 || *y > 1) return std::nullopt;
  return Eigen::Vector2d(*x, *y);
}

class RuleParser {
 public:
  RuleParser(std::string_view text, int line) : text_(text) { rule_.line = line; }

  /// Returns nothing when the line is empty.
  std::optional<FeelRule> parse() {
    skip_space();
    if (text_.empty()) return std::nullopt;
    parse_times();
    parse_what();
    if (accept("gain")) parse_gain();
    if (!text_.empty()) {
      wrong(rule_.line, quote(text_) + " follows the rule; only gain G can, as in gain 1.5");
    }
    return rule_;
  }

 private:
  void skip_space() {
    while (!text_.empty() && (text_.front() == ' ' || text_.front() == '\t')) {
      text_.remove_prefix(1);
    }
  }
  std::string_view next_word() const {
    size_t n = 0;
    while (n < text_.size() && text_[n] != ' ' && text_[n] != '\t') ++n;
    return text_.substr(0, n);
  }
  bool accept(std::string_view expected) {
    if (next_word() != expected) return false;
    text_.remove_prefix(expected.size());
    skip_space();
    return true;
  }
  /// Accepts all words up to the next one that begins with a letter, and joins them without spaces.
  std::string accept_numbers() {
    std::string numbers;
    while (!text_.empty() && !is_letter(text_.front())) {
      const std::string_view next = next_word();
      numbers += next;
      text_.remove_prefix(next.size());
      skip_space();
    }
    return numbers;
  }

  int64_t time(std::string_view text) const {
    const std::optional<int64_t> ns = time_ns(text);
    if (!ns) wrong(rule_.line, quote(text) + " is not a time such as 12.5, 0:12 or 1:02:03");
    return *ns;
  }
  void parse_times() {
    const std::string times = accept_numbers();
    if (times.empty()) return;
    const size_t dash = times.find('-');
    if (dash == std::string::npos) {
      wrong(rule_.line, quote(times) + " has no end: FROM-TO, or FROM- up to the end of the film");
    }
    rule_.from_ns = time(times.substr(0, dash));
    if (dash + 1 < times.size()) rule_.to_ns = time(times.substr(dash + 1));
    if (rule_.to_ns <= rule_.from_ns) wrong(rule_.line, quote(times) + " ends before it begins");
  }

  Eigen::Vector2d parse_position() {
    const std::string text = accept_numbers();
    const std::optional<Eigen::Vector2d> position = position_of(text.empty() ? next_word() : text);
    if (!position) {
      wrong(rule_.line,
            quote(text.empty() ? text_ : text) +
                " is not a position such as 0.31,0.62: fractions, from 0 to 1, of the picture's "
                "width and height, from its top left corner");
    }
    return *position;
  }
  void parse_region() {
    const Eigen::Vector2d a = parse_position();
    if (!accept("to")) wrong(rule_.line, "a region is region X,Y to X,Y, from corner to corner");
    const Eigen::Vector2d b = parse_position();
    rule_.position = a.cwiseMin(b);
    rule_.far_corner = a.cwiseMax(b);
    if ((rule_.far_corner.array() <= rule_.position.array()).any()) {
      wrong(rule_.line, "the region is empty: its corners are opposite ones");
    }
  }
  void parse_box() {
    rule_.kind = FeelRule::Kind::kBox;
    std::string_view name = next_word();
    if (name.empty() || name == "gain") return;
    const bool is_quoted = name.front() == '"';
    if (is_quoted) {
      const size_t end = text_.find('"', 1);
      if (end == std::string_view::npos || end == 1) {
        wrong(rule_.line,
              "the name of a box is one word, or in quotes, as in box \"traffic light\"");
      }
      name = text_.substr(1, end - 1);
    }
    if (name.size() > FeelRule::kLongestName) {
      wrong(rule_.line, "the name of a box has at most " + std::to_string(FeelRule::kLongestName) +
                            " bytes, and " + quote(name) + " more");
    }
    const auto is_control = [](unsigned char c) { return c < ' ' || c == 0x7f; };
    if (std::any_of(name.begin(), name.end(), is_control)) {
      wrong(rule_.line, "the name of a box has a control character: " + quote(name));
    }
    std::copy(name.begin(), name.end(), rule_.name.begin());
    text_.remove_prefix(name.size() + (is_quoted ? 2 : 0));
    skip_space();
  }
  void parse_what() {
    for (const Direction& direction : kDirections) {
      if (!accept(direction.word)) continue;
      rule_.kind = FeelRule::Kind::kFurthest;
      rule_.direction << direction.x, direction.y;
      return;
    }
    if (accept("object")) {
      if (!accept("at")) wrong(rule_.line, "an object is object at X,Y, as in object at 0.31,0.62");
      rule_.kind = FeelRule::Kind::kObjectAt;
      rule_.position = parse_position();
    } else if (accept("box")) {
      parse_box();
    } else if (accept("region")) {
      rule_.kind = FeelRule::Kind::kRegion;
      parse_region();
    } else if (accept("largest")) {
      rule_.kind = FeelRule::Kind::kLargest;
    } else if (accept("camera")) {
      rule_.kind = FeelRule::Kind::kCamera;
    } else if (accept("nothing")) {
      rule_.kind = FeelRule::Kind::kNothing;
    } else if (text_.empty()) {
      wrong(rule_.line, std::string("what is felt is missing, one of: ") + kAllWords);
    } else {
      wrong(rule_.line, quote(next_word()) + " is none of: " + kAllWords);
    }
  }
  void parse_gain() {
    const std::optional<double> gain = number_of(next_word());
    if (!gain || *gain < 0 || *gain > kMaxRuleGain) {
      wrong(rule_.line, quote(next_word()) + " is not a gain from 0 to 10");
    }
    rule_.gain = *gain;
    text_.remove_prefix(next_word().size());
    skip_space();
  }

  std::string_view text_;
  FeelRule rule_;
};

/// The name as a rule writes it: in quotes unless it is a single word.
std::string name_text(const std::string& name) {
  const bool is_word = name.find_first_of(" \t") == std::string::npos && name != "gain";
  return is_word ? name : '"' + name + '"';
}

}  // namespace

FeelRules::FeelRules(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
    text.remove_prefix(kByteOrderMark.size());
  }
  // Where all rules are in one line, as in a property, each rule counts as a line.
  const bool counts_rules = text.find('\n') == std::string_view::npos;
  for (int line = 1; !text.empty();) {
    const size_t end = text.find_first_of("\n;");
    std::string_view one = text.substr(0, end);
    // A semicolon in a comment does not end a rule.
    if (one.find('#') != std::string_view::npos) one = text.substr(0, text.find('\n'));
    const int this_line = line;
    line += counts_rules || text.substr(one.size(), 1) == "\n";
    text.remove_prefix(std::min(text.size(), one.size() + 1));
    one = one.substr(0, one.find('#'));
    while (!one.empty() && one.back() == '\r') one.remove_suffix(1);
    const std::optional<FeelRule> rule = RuleParser(one, this_line).parse();
    if (!rule) continue;
    if (!rules_.empty() && rule->from_ns < rules_.back().to_ns) {
      const FeelRule& before = rules_.back();
      const std::string its_end =
          before.to_ns == FeelRule::kNoEnd ? "never does" : "does so at " + time_text(before.to_ns);
      wrong(this_line, "it begins at " + time_text(rule->from_ns) + ", before line " +
                           std::to_string(before.line) + " ends, which " + its_end);
    }
    rules_.push_back(*rule);
  }
  if (rules_.empty()) wrong(1, std::string("there is no rule, which is one of: ") + kAllWords);
}

const FeelRule* FeelRules::at(int64_t stream_ns) const {
  const auto next =
      std::upper_bound(rules_.begin(), rules_.end(), stream_ns,
                       [](int64_t ns, const FeelRule& rule) { return ns < rule.from_ns; });
  if (next == rules_.begin()) return nullptr;
  const FeelRule& rule = *(next - 1);
  return stream_ns < rule.to_ns ? &rule : nullptr;
}

bool FeelRules::has_boxes() const {
  return std::any_of(rules_.begin(), rules_.end(),
                     [](const FeelRule& rule) { return rule.kind == FeelRule::Kind::kBox; });
}

std::string FeelRules::text() const {
  std::string text;
  for (const FeelRule& rule : rules_) text += (text.empty() ? "" : "; ") + rule_text(rule);
  return text;
}

std::string rule_text(const FeelRule& rule) {
  std::string text;
  if (rule.from_ns != 0 || rule.to_ns != FeelRule::kNoEnd) {
    text = time_text(rule.from_ns) + "-";
    text += (rule.to_ns == FeelRule::kNoEnd ? "" : time_text(rule.to_ns)) + " ";
  }
  switch (rule.kind) {
    case FeelRule::Kind::kObjectAt:
      text += "object at " + position_text(rule.position);
      break;
    case FeelRule::Kind::kLargest:
      text += "largest";
      break;
    case FeelRule::Kind::kFurthest:
      for (const Direction& direction : kDirections) {
        if (rule.direction == Eigen::Vector2d(direction.x, direction.y)) text += direction.word;
      }
      break;
    case FeelRule::Kind::kBox:
      text += rule.name[0] ? "box " + name_text(rule.name.data()) : "box";
      break;
    case FeelRule::Kind::kRegion:
      text += "region " + position_text(rule.position) + " to " + position_text(rule.far_corner);
      break;
    case FeelRule::Kind::kCamera:
      text += "camera";
      break;
    case FeelRule::Kind::kNothing:
      text += "nothing";
      break;
  }
  return rule.gain == 1 ? text : text.append(" gain ").append(NumberText(rule.gain));
}

std::string time_text(int64_t ns) {
  constexpr int64_t kSecond = 1'000'000'000;
  const auto seconds = static_cast<long long>(ns / kSecond);
  char text[40];
  if (seconds >= 3600) {
    std::snprintf(text, sizeof text, "%lld:%02lld:%02lld", seconds / 3600, seconds / 60 % 60,
                  seconds % 60);
  } else {
    std::snprintf(text, sizeof text, "%lld:%02lld", seconds / 60, seconds % 60);
  }
  std::string result = text;
  if (ns % kSecond == 0) return result;
  std::snprintf(text, sizeof text, ".%09lld", static_cast<long long>(ns % kSecond));
  result += text;
  return result.substr(0, result.find_last_not_of('0') + 1);
}

std::string position_text(const Eigen::Vector2d& position) {
  return std::string(NumberText(position.x())).append(",").append(NumberText(position.y()));
}

}  // namespace spidar
