// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Assigns clips and conditions to participants.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace study {

/// The paper's two comparisons.
enum class Part {
  kControllers,  ///< linear against nonlinear (Table 1)
  kHaptics,      ///< without haptics against with haptics (Table 2), nonlinear
};
enum class Condition { kLinear, kNonlinear, kWithout, kWith };

const char* to_string(Part part);
const char* to_string(Condition condition);
/// Throw std::invalid_argument for an unknown name.
Part part_of(const std::string& name);
Condition condition_of(const std::string& name);

/// One presentation of one clip.
struct Trial {
  int number = 0;  ///< from 1 on, in the order of presentation
  Part part = Part::kControllers;
  Condition condition = Condition::kLinear;
  std::string clip;
  std::string code;  ///< shown to the participant instead of the condition
};

/// All trials of participant `index` (0, 1, … in order of arrival). The two conditions of a clip
/// follow each other, and the paper's first comparison comes first. Clips are in random order. The
/// condition that comes first alternates from clip to clip and is reversed for the next
/// participant, so that after an even number of participants both orders are balanced for each
/// clip. The same arguments give the same trials on every machine. Throws std::invalid_argument
/// without clips or when one is given twice.
std::vector<Trial> schedule(const std::vector<std::string>& clips, int index, uint32_t seed);

}  // namespace study
