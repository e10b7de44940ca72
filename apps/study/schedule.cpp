// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "apps/study/schedule.h"

#include <algorithm>
#include <array>
#include <random>
#include <set>
#include <stdexcept>
#include <utility>

namespace study {
namespace {

constexpr std::array<Part, 2> kParts{Part::kControllers, Part::kHaptics};
constexpr std::array<Condition, 4> kConditions{Condition::kLinear, Condition::kNonlinear,
                                               Condition::kWithout, Condition::kWith};

std::pair<Condition, Condition> conditions_of(Part part) {
  if (part == Part::kControllers) return {Condition::kLinear, Condition::kNonlinear};
  return {Condition::kWithout, Condition::kWith};
}

/// std::shuffle and the distributions differ between standard libraries; the engine does not. For
/// so few elements the bias of the remainder is below 1e-8.
size_t below(std::mt19937& random, size_t count) {
  return random() % count;
}

template <typename T>
void shuffle(std::vector<T>& values, std::mt19937& random) {
  for (size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[below(random, i)]);
}

/// Codes of a letter and a digit, all different, without characters that can be confused.
std::vector<std::string> codes(std::mt19937& random) {
  std::vector<std::string> all;
  for (const char letter : std::string("ACDEFHJKLMNPRTUVWXY")) {
    for (const char digit : std::string("2345679")) all.push_back({letter, digit});
  }
  shuffle(all, random);
  return all;
}

}  // namespace

const char* to_string(Part part) {
  return part == Part::kControllers ? "controllers" : "haptics";
}

const char* to_string(Condition condition) {
  switch (condition) {
    case Condition::kLinear:
      return "linear";
    case Condition::kNonlinear:
      return "nonlinear";
    case Condition::kWithout:
      return "without";
    case Condition::kWith:
      break;
  }
  return "with";
}

Part part_of(const std::string& name) {
  for (const Part part : kParts) {
    if (name == to_string(part)) return part;
  }
  throw std::invalid_argument("\"" + name + "\" is no part; controllers and haptics are");
}

Condition condition_of(const std::string& name) {
  for (const Condition condition : kConditions) {
    if (name == to_string(condition)) return condition;
  }
  throw std::invalid_argument("\"" + name +
                              "\" is no condition; linear, nonlinear, without and with are");
}

std::vector<Trial> schedule(const std::vector<std::string>& clips, int index, uint32_t seed) {
  if (clips.empty()) throw std::invalid_argument("give at least one clip");
  if (std::set<std::string>(clips.begin(), clips.end()).size() != clips.size()) {
    throw std::invalid_argument("the same clip is given twice");
  }
  std::mt19937 random(seed + 0x9e3779b9U * static_cast<uint32_t>(index + 1));
  const std::vector<std::string> free_codes = codes(random);
  std::vector<Trial> trials;
  for (const Part part : kParts) {
    std::vector<size_t> order(clips.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = i;
    shuffle(order, random);
    for (const size_t clip : order) {
      auto [first, second] = conditions_of(part);
      if ((clip + static_cast<size_t>(index)) % 2 == 1) std::swap(first, second);
      for (const Condition condition : {first, second}) {
        Trial trial;
        trial.number = static_cast<int>(trials.size()) + 1;
        trial.part = part;
        trial.condition = condition;
        trial.clip = clips[clip];
        trial.code = free_codes[trials.size() % free_codes.size()];
        trials.push_back(trial);
      }
    }
  }
  return trials;
}

}  // namespace study
