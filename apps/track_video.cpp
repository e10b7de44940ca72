// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Prints what moves in a video, as one line of JSON for each frame:
//   track_video FILE [--points] [--motion=mean|object|objects|camera]
// FILE may be a URI. Each line has the time, the background's model, the objects (id, position,
// size, velocity relative to the background and on the screen, growth, roll) and the motion that
// would be felt; core/analysis/analysis_json.h lists the keys. --points adds the points with their
// motion, as [id, x, y, moved x, moved y]. Positions are in pixels from the centre of the frame, x
// right, y down.
//   track_video film.mkv | jq -c '.objects[] | [.id, .velocity_px_s]'
#include <cstdio>
#include <cstring>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>

#include <gst/gst.h>

#include "apps/help.h"
#include "apps/track/luma_reader.h"
#include "core/analysis/analysis_json.h"
#include "core/analysis/motion_analyzer.h"

using namespace spidar;

namespace {

constexpr const char* kUsage =
    "usage: track_video FILE [--points] [--motion=mean|object|objects|camera]\n";

std::optional<MotionKind> motion_kind(const std::string& name) {
  if (name == "mean") return MotionKind::kMean;
  if (name == "object") return MotionKind::kObject;
  if (name == "objects") return MotionKind::kObjects;
  if (name == "camera") return MotionKind::kCamera;
  return {};
}

struct Command {
  std::string video;
  JsonOptions json;
  MotionKind motion = MotionKind::kObject;
};

std::optional<Command> parse(int argc, char** argv) {
  constexpr const char* kMotion = "--motion=";
  Command command;
  for (int k = 1; k < argc; ++k) {
    const std::string argument = argv[k];
    if (argument == "--points") {
      command.json.points = true;
    } else if (argument.rfind(kMotion, 0) == 0) {
      const std::optional<MotionKind> kind = motion_kind(argument.substr(std::strlen(kMotion)));
      if (!kind) return {};
      command.motion = *kind;
    } else if (command.video.empty() && argument[0] != '-') {
      command.video = argument;
    } else {
      return {};
    }
  }
  if (command.video.empty()) return {};
  return command;
}

void run(const Command& command) {
  LumaReader video(command.video);
  AnalyzerSettings settings;
  settings.motion = command.motion;
  MotionAnalyzer analyzer(settings);
  LumaReader::Frame frame;
  std::string line;
  while (video.next(frame)) {
    const FrameAnalysis analysis = analyzer.analyze(frame.luma, frame.running_time_ns);
    line.clear();
    append_json(analysis, frame.running_time_ns, frame.stream_time_ns, command.json, line);
    if (std::fwrite(line.data(), 1, line.size(), stdout) != line.size()) {
      throw std::runtime_error("standard output cannot be written");
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (asks_for_help(argc, argv, kUsage)) return 0;
  const std::optional<Command> command = parse(argc, argv);
  if (!command) {
    std::fputs(kUsage, stderr);
    return 2;
  }
  gst_init(nullptr, nullptr);
  try {
    run(*command);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "track_video: %s\n", error.what());
    return 1;
  }
  if (std::fflush(stdout) == 0) return 0;
  std::fputs("track_video: standard output cannot be written\n", stderr);
  return 1;
}
