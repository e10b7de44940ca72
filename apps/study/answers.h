// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The file of the participants' answers.
#pragma once

#include <string>
#include <vector>

#include "apps/study/schedule.h"

namespace study {

/// Steps from bad to very good, as in the paper: bad, poor, average, good, very good.
constexpr int kSteps = 5;
constexpr int kFirstGood = 3;     ///< the paper counts "average" as good
const char* step_name(int step);  ///< 1 … kSteps

struct Question {
  std::string name;  ///< in the file
  std::string text;
};
/// The paper's questions: movement for the controllers; reality, interactivity and comfort for
/// haptics.
std::vector<Question> questions(Part part);

/// One row of the file.
struct Answer {
  std::string participant;
  Trial trial;
  std::string question;
  int step = 0;      ///< 1 … kSteps
  std::string time;  ///< UTC, ISO 8601
};

/// Reads a CSV file with a header line; a missing file counts as empty. Throws std::runtime_error
/// that names file, line and what is wrong.
std::vector<Answer> read_answers(const std::string& path);

/// Throws std::invalid_argument for text that cannot be written to the file: commas, quotes and
/// line breaks would need quoting.
void check_name(const std::string& text);

/// UTC, ISO 8601.
std::string utc_now();

/// Appends a line and flushes it to the disk; creates the file, with a first line `header`, if
/// there is none. Throws std::runtime_error.
void append_line(const std::string& path, const std::string& header, const std::string& line);

/// Appends a row and flushes it to the disk; creates the file if there is none. Throws
/// std::runtime_error, and std::invalid_argument as check_name() does.
void append_answer(const std::string& path, const Answer& answer);

/// Position of the participant in the order of first answers; a new participant comes last.
int index_of(const std::vector<Answer>& answers, const std::string& participant);

/// Throws std::invalid_argument when the participant has answered other trials: to continue, clips
/// and seed must be the same as before.
void check_same_trials(const std::vector<Answer>& answers, const std::string& participant,
                       const std::vector<Trial>& trials);

/// Whether the question of this trial has been answered.
bool is_answered(const std::vector<Answer>& answers, const std::string& participant,
                 const Trial& trial, const std::string& question);

}  // namespace study
