// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Who sees and feels what, in which order.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace study {

/// The paper's two comparisons.
enum class Part {
  kControllers,  ///< linear against nonlinear (Table 1)
  kHaptics,      ///< without against with haptics (Table 2), the latter nonlinear
};
enum class Condition { kLinear, kNonlinear, kWithout, kWith };

const char* to_string(Part part);
const char* to_string(Condition condition);
/// Throw std::invalid_argument for a name that is none.
Part part_of(const std::string& name);
Condition condition_of(const std::string& name);

/// One clip, once.
struct Trial {
  int number = 0;  ///< from 1 on, as the participant goes through them
  Part part = Part::kControllers;
  Condition condition = Condition::kLinear;
  std::string clip;
  std::string code;  ///< what the participant is told instead of the condition
};

/// All trials of participant `index` (0, 1, … in the order in which they came): the two conditions
/// of a clip follow each other, the paper's first comparison comes first. Clips are in random
/// order; which condition comes first alternates from clip to clip, and is the other one for the
/// next participant, so that after an even number of participants each clip was seen as often one
/// way as the other. The same arguments give the same trials, on every machine. Throws
/// std::invalid_argument without clips or with the same one twice.
std::vector<Trial> schedule(const std::vector<std::string>& clips, int index, uint32_t seed);

}  // namespace study
