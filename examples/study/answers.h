// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What participants answered, in a file.
#pragma once

#include <string>
#include <vector>

#include "examples/study/schedule.h"

namespace study {

/// Bad, poor, average, good, very good, as in the paper.
constexpr int kSteps = 5;
constexpr int kFirstGood = 3;     ///< the paper counts "average" as good
const char* step_name(int step);  ///< 1 … kSteps

struct Question {
  std::string name;  ///< in the file
  std::string text;
};
/// The paper's: movement for the controllers; reality, interactivity and comfort for haptics.
std::vector<Question> questions(Part part);

/// One row of the file.
struct Answer {
  std::string participant;
  Trial trial;
  std::string question;
  int step = 0;      ///< 1 … kSteps
  std::string time;  ///< UTC, ISO 8601
};

/// CSV with a header line, as answered. No file: empty.
/// Throws std::runtime_error that names file, line and what is wrong.
std::vector<Answer> read_answers(const std::string& path);

/// Throws std::invalid_argument for text that cannot stand in the file: commas, quotes and line
/// ends would need to be quoted.
void check_name(const std::string& text);

/// Appends a row and brings it to the disk; the file is made when there is none.
/// Throws std::runtime_error, and std::invalid_argument as check_name() does.
void append_answer(const std::string& path, const Answer& answer);

/// Position of the participant among all, in the order of their first answers; a new one comes
/// next.
int index_of(const std::vector<Answer>& answers, const std::string& participant);

/// Throws std::invalid_argument when the participant has answered to trials that are not these: to
/// go on, clips and seed must be those of before.
void check_same_trials(const std::vector<Answer>& answers, const std::string& participant,
                       const std::vector<Trial>& trials);

/// True when the question of this trial has its answer.
bool is_answered(const std::vector<Answer>& answers, const std::string& participant,
                 const Trial& trial, const std::string& question);

}  // namespace study
