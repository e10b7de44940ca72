// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "apps/study/answers.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <unistd.h>

namespace study {
namespace {

constexpr const char* kHeader =
    "participant,trial,part,condition,code,clip,question,answer,time_utc";
constexpr size_t kColumns = 9;

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream rest(line);
  for (std::string field; std::getline(rest, field, ',');) fields.push_back(field);
  return fields;
}

int whole_number(const std::string& text, int low, int high) {
  char* end = nullptr;
  const long value = std::strtol(text.c_str(), &end, 10);
  if (text.empty() || *end || value < low || value > high) {
    throw std::invalid_argument("\"" + text + "\" is no number from " + std::to_string(low) +
                                " to " + std::to_string(high));
  }
  return static_cast<int>(value);
}

Answer parse(const std::string& line) {
  const std::vector<std::string> fields = split(line);
  if (fields.size() != kColumns) {
    throw std::invalid_argument(std::to_string(fields.size()) + " columns, not " +
                                std::to_string(kColumns));
  }
  Answer answer;
  answer.participant = fields[0];
  answer.trial.number = whole_number(fields[1], 1, 1'000'000);
  answer.trial.part = part_of(fields[2]);
  answer.trial.condition = condition_of(fields[3]);
  answer.trial.code = fields[4];
  answer.trial.clip = fields[5];
  answer.question = fields[6];
  answer.step = whole_number(fields[7], 1, kSteps);
  answer.time = fields[8];
  return answer;
}

}  // namespace

const char* step_name(int step) {
  static const char* const names[kSteps] = {"bad", "poor", "average", "good", "very good"};
  return names[std::clamp(step, 1, kSteps) - 1];
}

std::vector<Question> questions(Part part) {
  if (part == Part::kControllers) {
    return {{"movement", "How well did you feel the movement of the objects in the video?"}};
  }
  return {{"reality", "How real did the scene feel?"},
          {"interactivity", "How much did you feel a part of the scene?"},
          {"comfort", "How comfortable was it?"}};
}

std::vector<Answer> read_answers(const std::string& path) {
  std::vector<Answer> answers;
  std::ifstream file(path);
  if (!file) {
    if (errno == ENOENT) return answers;
    throw std::runtime_error(path + ": " + std::strerror(errno));
  }
  std::string line;
  if (!std::getline(file, line)) return answers;
  if (line != kHeader) {
    throw std::runtime_error(path + ":1: not a file of answers, which begins with " + kHeader);
  }
  for (int number = 2; std::getline(file, line); ++number) {
    try {
      answers.push_back(parse(line));
    } catch (const std::invalid_argument& e) {
      throw std::runtime_error(path + ":" + std::to_string(number) + ": " + e.what());
    }
  }
  return answers;
}

void check_name(const std::string& text) {
  if (text.empty() || text.find_first_of(",\"\r\n") != std::string::npos) {
    throw std::invalid_argument("\"" + text + "\" cannot be used as a name: it is empty or has a " +
                                "comma, a quote or a line end in it");
  }
}

std::string utc_now() {
  char text[32];
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

void append_line(const std::string& path, const std::string& header, const std::string& line) {
  std::FILE* file = std::fopen(path.c_str(), "ae");
  if (!file) throw std::runtime_error(path + ": " + std::strerror(errno));
  const bool is_new = std::fseek(file, 0, SEEK_END) == 0 && std::ftell(file) == 0;
  if (is_new) std::fprintf(file, "%s\n", header.c_str());
  std::fprintf(file, "%s\n", line.c_str());
  const bool written = std::fflush(file) == 0 && std::ferror(file) == 0 && fsync(fileno(file)) == 0;
  const int error = errno;
  std::fclose(file);
  if (!written) throw std::runtime_error(path + ": " + std::strerror(error));
}

void append_answer(const std::string& path, const Answer& answer) {
  for (const std::string& text : {answer.participant, answer.trial.clip, answer.question}) {
    check_name(text);
  }
  const Trial& trial = answer.trial;
  std::ostringstream line;
  line << answer.participant << ',' << trial.number << ',' << to_string(trial.part) << ','
       << to_string(trial.condition) << ',' << trial.code << ',' << trial.clip << ','
       << answer.question << ',' << answer.step << ',' << answer.time;
  append_line(path, kHeader, line.str());
}

int index_of(const std::vector<Answer>& answers, const std::string& participant) {
  std::vector<std::string> seen;
  for (const Answer& answer : answers) {
    if (std::find(seen.begin(), seen.end(), answer.participant) == seen.end()) {
      seen.push_back(answer.participant);
    }
  }
  return static_cast<int>(std::find(seen.begin(), seen.end(), participant) - seen.begin());
}

void check_same_trials(const std::vector<Answer>& answers, const std::string& participant,
                       const std::vector<Trial>& trials) {
  for (const Answer& answer : answers) {
    if (answer.participant != participant) continue;
    const Trial& given = answer.trial;
    const auto number = static_cast<size_t>(given.number);
    if (number > trials.size() || trials[number - 1].clip != given.clip ||
        trials[number - 1].condition != given.condition || trials[number - 1].code != given.code) {
      throw std::invalid_argument(participant +
                                  " has begun with other clips or another seed: trial " +
                                  std::to_string(given.number) + " was " + given.clip + ", " +
                                  to_string(given.condition) + "; give the same again");
    }
  }
}

bool is_answered(const std::vector<Answer>& answers, const std::string& participant,
                 const Trial& trial, const std::string& question) {
  return std::any_of(answers.begin(), answers.end(), [&](const Answer& answer) {
    return answer.participant == participant && answer.trial.number == trial.number &&
           answer.question == question;
  });
}

}  // namespace study
