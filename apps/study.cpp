// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The paper's experiment with people: which controller feels better, and what haptics add.

#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gst/gst.h>

#include "apps/film/film_uri.h"
#include "apps/help.h"
#include "apps/play/pipeline.h"
#include "apps/play/playback.h"
#include "apps/play/properties.h"
#include "apps/study/analysis.h"
#include "apps/study/answers.h"
#include "apps/study/briefing.h"
#include "apps/study/schedule.h"
#include "apps/study/terminal.h"

namespace {

using namespace study;

constexpr const char* kUsage =
    "usage: study run ANSWERS.csv PARTICIPANT CLIP... [option...] [-- name=value ...]\n"
    "       study report ANSWERS.csv\n"
    "  run     asks for consent, for reasons to exclude the participant, and for a test of the\n"
    "          emergency stop; then plays clips and asks; goes on where this participant stopped\n"
    "  report  percentages, means, and a sign test of all answers\n"
    "  --seed N              another random order of clips; the same for all of a study\n"
    "  --question NAME=TEXT  one more question after each clip, on the same five steps\n"
    "  --headless            no window for the video\n"
    "  name=value            properties of spidarmotion, the same for all clips; without "
    "max-force,\n"
    "                        the largest force is 1 N, and more must be confirmed\n"
    "ANSWERS.csv.briefings keeps what was asked before, ANSWERS.csv.traces/ what was felt.\n";

struct Options {
  std::string answers;
  std::string participant;
  std::vector<std::string> clips;
  std::vector<Question> questions;
  std::vector<std::string> assignments;
  uint32_t seed = 1;
  bool headless = false;
};

Question question_of(const std::string& text) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos || equals + 1 == text.size()) {
    throw std::invalid_argument("--question " + text + " is not NAME=TEXT");
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

uint32_t seed_of(const std::string& text) {
  char* end = nullptr;
  const unsigned long value = std::strtoul(text.c_str(), &end, 10);
  if (text.empty() || *end || value > UINT32_MAX) {
    throw std::invalid_argument("--seed " + text + " is not a whole number");
  }
  return static_cast<uint32_t>(value);
}

/// Throws std::invalid_argument.
Options parse(const std::vector<std::string>& arguments) {
  Options options;
  std::vector<std::string> names;
  for (size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    if (argument == "--") {
      options.assignments.assign(arguments.begin() + static_cast<ptrdiff_t>(i) + 1,
                                 arguments.end());
      break;
    }
    if (argument == "--headless") {
      options.headless = true;
    } else if (argument == "--seed" && i + 1 < arguments.size()) {
      options.seed = seed_of(arguments[++i]);
    } else if (argument == "--question" && i + 1 < arguments.size()) {
      options.questions.push_back(question_of(arguments[++i]));
    } else if (argument.size() > 1 && argument[0] == '-') {
      throw std::invalid_argument("unknown or incomplete option " + argument + "\n" + kUsage);
    } else {
      names.push_back(argument);
    }
  }
  if (names.size() < 3) throw std::invalid_argument(kUsage);
  options.answers = names[0];
  options.participant = names[1];
  options.clips.assign(names.begin() + 2, names.end());
  return options;
}

/// The value that an option after "--" gives a property; empty without one.
std::string given(const Options& options, const std::string& property) {
  std::string value;
  for (const std::string& assignment : options.assignments)
    if (assignment.compare(0, property.size() + 1, property + "=") == 0)
      value = assignment.substr(property.size() + 1);
  return value;
}

/// A player that is stopped and released at the end.
class Player {
 public:
  Player(const std::string& clip, const Options& options,
         const std::vector<std::string>& assignments)
      : filter_(make_filter()) {
    gst_object_ref_sink(filter_);
    if (given(options, "max-force").empty()) set_property(filter_, "max-force=1");
    // Everyone feels the same of a clip that was analysed before, on a busy machine, too.
    set_property(filter_, "analysis=auto");
    for (const std::string& assignment : options.assignments) set_property(filter_, assignment);
    for (const std::string& assignment : assignments) set_property(filter_, assignment);
    pipeline_ = make_player(film_uri(clip), filter_, open_screen(options.headless));
  }
  ~Player() {
    gst_element_set_state(pipeline_, GST_STATE_NULL);
    gst_object_unref(pipeline_);
    gst_object_unref(filter_);
  }
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;

  GstElement* pipeline() const { return pipeline_; }

 private:
  GstElement* filter_;
  GstElement* pipeline_ = nullptr;
};

/// A file name for a trace that no earlier one has: a trial that was stopped is played again.
std::string trace_file(const Options& options, const Trial& trial) {
  const std::filesystem::path folder = options.answers + ".traces";
  std::filesystem::create_directories(folder);
  const std::string name = options.participant + "-" + std::to_string(trial.number);
  std::string file;
  for (int again = 1; file.empty() || std::filesystem::exists(file + ".csv"); ++again)
    file = (folder / (again == 1 ? name : name + "-" + std::to_string(again))).string();
  return file;
}

Ending play(const Trial& trial, const Options& options) {
  const std::string file = trace_file(options, trial);
  std::vector<std::string> assignments{
      trial.condition == Condition::kLinear ? "controller=linear" : "controller=nonlinear",
      "trace=" + file + ".csv", "haptic-trace=" + file + ".haptic.csv"};
  if (trial.condition == Condition::kWithout) assignments.push_back("mute=true");
  const Player player(trial.clip, options, assignments);
  return run_playback(player.pipeline(), 0, [&] { return "clip " + trial.code; });
}

/// The strings have their minimum tension, in PAUSED as with mute=true.
void while_taut(const Options& options, const std::function<void()>& run) {
  const Player player(options.clips.front(), options, {"mute=true"});
  gst_element_set_state(player.pipeline(), GST_STATE_PAUSED);
  if (gst_element_get_state(player.pipeline(), nullptr, nullptr, 10 * GST_SECOND) ==
      GST_STATE_CHANGE_FAILURE)
    throw std::runtime_error("the device cannot be opened; examples/play.sh says why");
  run();
}

bool may_take_part(const Options& options) {
  Briefing briefing;
  briefing.record = options.answers + ".briefings";
  briefing.participant = options.participant;
  const std::string force = given(options, "max-force");
  if (!force.empty()) briefing.force_N = std::strtod(force.c_str(), nullptr);
  const std::string device = given(options, "device");
  const bool simulated = device.empty() || device == "none" || device.compare(0, 3, "sim") == 0;
  if (!simulated)
    briefing.while_taut = [&](const std::function<void()>& run) { while_taut(options, run); };
  return brief(briefing, std::cin, std::cout);
}

/// Returns false when the participant stops here.
bool run_trial(const Trial& trial, const std::vector<Question>& open, const Options& options) {
  if (!wait_for_return(std::cin, std::cout)) return false;
  const Ending ending = play(trial, options);
  if (ending == Ending::kFailed) throw std::runtime_error(trial.clip + " could not be played");
  if (ending == Ending::kInterrupted) return false;
  for (const Question& question : open) {
    const int step = ask(question, std::cin, std::cout);
    if (step == 0) return false;
    append_answer(options.answers, {options.participant, trial, question.name, step, utc_now()});
  }
  return true;
}

int run(const Options& options) {
  check_name(options.participant);
  for (const std::string& clip : options.clips) {
    check_name(clip);
    film_uri(clip);  // checks that all clips exist before the first one is shown
  }
  for (const Question& question : options.questions) check_name(question.name);
  const std::vector<Answer> answers = read_answers(options.answers);
  const std::vector<Trial> trials =
      schedule(options.clips, index_of(answers, options.participant), options.seed);
  check_same_trials(answers, options.participant, trials);
  if (!may_take_part(options)) return 1;
  for (const Trial& trial : trials) {
    std::vector<Question> open;
    std::vector<Question> all = questions(trial.part);
    all.insert(all.end(), options.questions.begin(), options.questions.end());
    for (const Question& question : all) {
      if (!is_answered(answers, options.participant, trial, question.name)) {
        open.push_back(question);
      }
    }
    if (open.empty()) continue;
    std::printf("\nclip %d of %zu, code %s\n", trial.number, trials.size(), trial.code.c_str());
    if (!run_trial(trial, open, options)) {
      std::printf("\nstopped; the same command goes on here\n");
      return 0;
    }
  }
  std::printf("\nthat was all; thank you\n");
  return 0;
}

int report_file(const std::string& path) {
  const std::vector<Answer> answers = read_answers(path);
  if (answers.empty()) throw std::runtime_error(path + ": there are no answers in it");
  std::fputs(report(answers).c_str(), stdout);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  if (asks_for_help(argc, argv, kUsage)) return 0;
  try {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    if (arguments.size() == 2 && arguments[0] == "report") return report_file(arguments[1]);
    if (arguments.empty() || arguments[0] != "run") throw std::invalid_argument(kUsage);
    const Options options = parse({arguments.begin() + 1, arguments.end()});
    gst_init(nullptr, nullptr);
    return run(options);
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
