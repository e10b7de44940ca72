// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "plugin/tools/film_analyzer.h"
#include "plugin/tools/record_properties.h"
#include "plugin/tools/spidartrack_commands.h"
#include "plugin/tools/track_samples.h"
#include "plugin/track/motion_sidecar.h"
#include "plugin/track/part_file.h"
#include "plugin/track/sidecar.h"
#include "spidar/tools/command_line.h"
#include "spidar/tools/exit_status.h"

namespace spidar {
namespace {

constexpr const char* kRenderHelp =
    R"(usage: spidartrack render FILM.motion [TRACK] [-- PROPERTY=VALUE...]

Makes of an analysis (spidartrack analyze FILM) the track that spidartrack record would make of the
film, to the last bit, without the film: another force in seconds. TRACK ends in .flac, .mka or .wav,
and is FILM.haptic.flac unless given; a file of this name is replaced. Properties are those of
spidarmotion that change the force: controller=adaptive motion=objects max-force=2 …;
trace=FILM.jsonl writes what was measured, and is felt, as lines of JSON.
)";

std::string film_of(const std::string& motion) {
  const std::string end = kMotionEnd;
  return ends_with(motion, end) ? motion.substr(0, motion.size() - end.size()) : motion;
}

}  // namespace

int render_track_command(int argc, char** argv) {
  // getopt must not see the arguments after --.
  char** const dashes = std::find(argv + 1, argv + argc, std::string("--"));
  const std::vector<std::string> words(dashes == argv + argc ? dashes : dashes + 1, argv + argc);
  bool help = false;
  const std::vector<std::string> operands =
      parse_options(static_cast<int>(dashes - argv), argv,
                    {{"help", false, [&](const std::string&) { help = true; }}});
  if (help) {
    std::cout << kRenderHelp;
    return kDone;
  }
  if (operands.empty()) throw UsageError("no FILM.motion given");
  if (operands.size() > 2) {
    throw UsageError(operands[2] + ": only FILM.motion and TRACK; properties follow --");
  }
  const std::string& motion = operands[0];
  const std::string track = operands.size() == 2 ? operands[1] : film_of(motion) + ".haptic.flac";
  if (encoder_of(track).empty()) throw UsageError(track + ": ends in none of .flac, .mka, .wav");
  const RecordProperties properties = parse_record_properties(words, 1, Purpose::kRender);
  std::error_code none;
  if (std::filesystem::equivalent(motion, track, none)) {
    throw UsageError(track + ": is to be another file than the analysis");
  }
  try {
    PartFile part(track);
    for (const std::string& remark : render_analysis(motion, part.path(), properties)) {
      std::cerr << "spidartrack: " << remark << '\n';
    }
    part.publish();
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(motion + ": " + error.what());
  }
  const std::string why = why_not_played(film_of(motion), track);
  if (!why.empty()) std::cerr << "spidartrack: " << why << '\n';
  std::cout << track << '\n';
  return kDone;
}

}  // namespace spidar
