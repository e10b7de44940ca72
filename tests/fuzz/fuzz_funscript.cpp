// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Fuzz target of the reader and the writer of funscripts; tests/README.md says how to run it under
// libFuzzer. The bytes are read as a file, and once more as a selection of words of such a file.
// The result must be an error, or axes within the full scale, of which the first stays the same but
// for the tolerance when it is written and read.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <string>
#include <vector>

#include "core/track/funscript.h"
#include "tests/support/written_tracks.h"

using namespace spidar;

namespace {

constexpr size_t kChannel = 1;
constexpr int64_t kMaxSamples = 10000;
/// Of a line, of the rounding of its ends, and of floats.
constexpr double kDifference = kFunscriptTolerance + 0.01 + 1e-6;

[[noreturn]] void fail(const char* why) {
  std::fprintf(stderr, "%s\n", why);
  std::abort();
}

/// A script that is written of it is the same but for the tolerance.
void check_written(ScriptAxis axis) {
  axis.gain = 1;
  const int64_t end_ms = axis.points.back().at_ms + 1;
  if (end_ms < 1 || end_ms > kMaxSamples) return;
  std::vector<TrackSample> samples(static_cast<size_t>(end_ms));
  for (int64_t i = 0; i < end_ms; ++i) samples[static_cast<size_t>(i)][kChannel] = axis.at(i);
  const ScriptAxis again = parse_funscript(write_funscript(samples, kChannel), 0).axes.at(0);
  if (again.channel != kChannel || again.gain != 1) fail("its notes are lost");
  if (again.points.back().at_ms + 1 != end_ms) fail("the track is not as long as it was");
  for (int64_t i = 0; i < end_ms; ++i) {
    if (std::fabs(again.at(i) - axis.at(i)) > kDifference) fail("a sample that has moved");
  }
}

/// Of the track's full scale.
double most_of(const ScriptAxis& axis) {
  return 1 / axis.gain * (1 + 1e-6);
}

void read(const std::string& text) {
  Funscript script;
  try {
    script = parse_funscript(text, kChannel);
  } catch (const TrackFileError& error) {
    if (*error.what() == '\0') fail("an error without words");
    return;
  }
  uint32_t channels = 0;
  for (const ScriptAxis& axis : script.axes) {
    if (axis.channel >= kTrackChannels || (channels >> axis.channel & 1U) != 0) fail("a channel");
    channels |= 1U << axis.channel;
    if (!(axis.gain >= kMinGain && axis.gain <= kMaxGain)) fail("a gain out of its range");
    for (size_t i = 0; i < axis.points.size(); ++i) {
      const int64_t at_ms = axis.points[i].at_ms;
      if (i > 0 && at_ms <= axis.points[i - 1].at_ms) fail("times that do not rise");
      for (const int64_t ms : {at_ms - 1, at_ms, at_ms + 1}) {
        if (!(std::fabs(axis.at(ms)) <= most_of(axis))) fail("a sample beyond the full scale");
      }
    }
  }
  if (script.axes.empty() || script.axes[0].points.empty()) return;
  check_written(script.axes[0]);
}

/// What a file is made of, and a little of what it is not.
constexpr const char* kWords[] = {
    R"({"version":"1.0","inverted":true,"range":90,"actions":[)",
    R"({"actions":[)",
    R"({"range":0,"actions":[)",
    R"({"range":-1e308,"actions":[)",
    R"({"range":null,"inverted":7,"actions":[)",
    R"({"at":0,"pos":50},)",
    R"({"at":1,"pos":0},)",
    R"({"at":17.5,"pos":99.9},)",
    R"({"at":9998,"pos":100},)",
    R"({"at":9999,"pos":3})",
    R"({"at":1e300,"pos":3})",
    R"({"at":-1,"pos":101})",
    R"({"pos":{}})",
    R"({"gst-spidar":{"channel":5,"gain":0.001},"actions":[)",
    R"({"axes":[{"id":"R1","actions":[)",
    R"({"axes":[{"id":"V0"},{"id":"l0","actions":[)",
    R"({"channels":{"roll":{"actions":[)",
    "]}]}",
    "]}}}",
    "]}",
    "[",
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  read(std::string(reinterpret_cast<const char*>(data), size));
  std::string text;
  for (size_t i = 0; i < size && i < 64; ++i) text += kWords[data[i] % std::size(kWords)];
  read(text);
  return 0;
}
