// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Fuzz target of the reader and the writer of funscripts; tests/README.md says how to run it under
// libFuzzer. The bytes are read as a file, and once more as a selection of words of such a file.
// The result must be an error, or a track of allowed length within the full scale, which stays the
// same but for the tolerance when it is written and read.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <string>
#include <vector>

#include "core/track/exchange_formats.h"
#include "tests/support/written_tracks.h"

using namespace spidar;

namespace {

constexpr size_t kMostSamples = 10000, kChannel = 1;
/// Of a line, of the rounding of its ends, and of floats.
constexpr double kDifference = kFunscriptTolerance + 0.01 + 1e-6;

[[noreturn]] void fail(const char* why) {
  std::fprintf(stderr, "%s\n", why);
  std::abort();
}

void read(const std::string& text) {
  std::vector<TrackSample> samples;
  try {
    samples = read_funscript(text, kChannel, kMostSamples);
  } catch (const FunscriptError&) {
    return;
  }
  if (samples.size() > kMostSamples) fail("a track that is too long");
  const std::vector<TrackSample> again =
      read_funscript(write_funscript(samples, kChannel), kChannel, kMostSamples);
  if (again.size() != samples.size()) fail("the track is not as long as it was");
  for (size_t i = 0; i < samples.size(); ++i) {
    const double value = samples[i][kChannel];
    if (!(std::fabs(value) <= 1)) fail("a sample beyond the full scale");
    if (std::fabs(again[i][kChannel] - value) > kDifference) fail("a sample that has moved");
  }
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
