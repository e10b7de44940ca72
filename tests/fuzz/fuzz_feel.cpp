// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Fuzz target of the rules of what is felt; tests/README.md says how to run it under libFuzzer.
// The bytes are read as a .feel file, and once more as a selection of words of such a file. The
// result must be an error that names a line, or rules that hold no number out of its range, that do
// not overlap, and that mean the same when they are written and read again.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <string>

#include "core/choice/feel_rules.h"

using namespace spidar;

namespace {

[[noreturn]] void fail(const char* what, const std::string& text) {
  std::fprintf(stderr, "%s: %s\n", what, text.c_str());
  std::abort();
}

bool is_position(const Eigen::Vector2d& position) {
  return (position.array() >= 0).all() && (position.array() <= 1).all();
}

bool is_sound(const FeelRule& rule) {
  const bool has_end = std::find(rule.name.begin(), rule.name.end(), '\0') != rule.name.end();
  const bool has_direction =
      rule.kind != FeelRule::Kind::kFurthest || std::fabs(rule.direction.norm() - 1) < 1e-12;
  return rule.from_ns >= 0 && rule.to_ns > rule.from_ns && rule.line > 0 && has_end &&
         has_direction && is_position(rule.position) && is_position(rule.far_corner) &&
         rule.gain >= 0 && rule.gain <= 10;
}

void check(const FeelRules& rules) {
  if (rules.rules().empty()) fail("no rule, and no error", "");
  int64_t end_ns = 0;
  for (const FeelRule& rule : rules.rules()) {
    if (!is_sound(rule) || rule.from_ns < end_ns) fail("a wrong rule", rule_text(rule));
    end_ns = rule.to_ns;
    if (rules.at(rule.from_ns) != &rule || rules.at(rule.to_ns - 1) != &rule) {
      fail("a rule that does not hold", rule_text(rule));
    }
  }
}

void read(const std::string& text) {
  std::string written;
  try {
    const FeelRules rules(text);
    check(rules);
    written = rules.text();
  } catch (const FeelRulesError& error) {
    if (*error.what() == '\0') fail("an error without words", text);
    return;
  }
  try {
    const std::string again = FeelRules(written).text();
    if (again != written) fail("other rules when they are read again", written);
  } catch (const FeelRulesError& error) {
    fail(error.what(), written);
  }
}

/// What a file is made of, and a little of what it is not.
constexpr const char* kWords[] = {
    "0:12-",   "1:02:03.5 - ", "12.5",        "-",        "0.31,0.62", "1,0 to 0,1",   "object at ",
    "region",  "largest",      "leftmost",    "topmost",  "camera",    "nothing",      "box ",
    "\"a b\"", "face",         " gain 1.5",   " gain 11", ";",         "\n",           " ",
    "# ;",     "1e308",        "99999999999", "nan",      "-1",        "\xEF\xBB\xBF", "\"",
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  read(std::string(reinterpret_cast<const char*>(data), size));
  std::string text;
  for (size_t i = 0; i < size && i < 64; ++i) text += kWords[data[i] % std::size(kWords)];
  read(text);
  return 0;
}
