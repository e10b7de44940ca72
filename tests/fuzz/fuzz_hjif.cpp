// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Fuzz target of the reader of HJIF; tests/README.md says how to run it under libFuzzer.
// The bytes are read as a file, and once more as a selection of words of such a file. The result
// must be an error, or a track of allowed length that contains only finite numbers.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <string>

#include "core/track/exchange_formats.h"

using namespace spidar;

namespace {

constexpr size_t kMaxSamples = 10000;

void read(const std::string& text) {
  try {
    const std::vector<TrackSample> samples = read_hjif(text, kMaxSamples);
    bool sound = samples.size() <= kMaxSamples;
    for (const TrackSample& sample : samples) {
      for (const float value : sample) sound = sound && std::isfinite(value);
    }
    if (sound) return;
  } catch (const TrackFileError&) {
    return;
  }
  std::fputs("a track that is too long or has no numbers\n", stderr);
  std::abort();
}

/// What a file is made of, and a little of what it is not.
constexpr const char* kWords[] = {
    R"({"timescale":1000,"perceptions":[{"perception_modality":"Force","channels":[)",
    R"({"timescale":48000,"perceptions":[{"perception_modality":"Force","channels":[)",
    R"({"gain":1,"bands":[]},)",
    R"({"gain":1,"bands":[]})",
    R"({"gain":2,"sample_count":500,"frequency_sampling":1000,"bands":[)",
    R"({"band_type":"Curve","curve_type":"Linear","effects":[)",
    R"({"band_type":"Transient","curve_type":"Linear","effects":[)",
    R"({"position":0,"keyframes":[)",
    R"({"position":97,"keyframes":[)",
    R"({"relative_position":0,"amplitude_modulation":0.5})",
    R"({"relative_position":40,"amplitude_modulation":-1})",
    R"({"relative_position":2147483647,"amplitude_modulation":1e308})",
    R"({"relative_position":-7,"amplitude_modulation":null})",
    ",",
    "]}",
    "]}]}",
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  read(std::string(reinterpret_cast<const char*>(data), size));
  std::string text;
  for (size_t i = 0; i < size && i < 64; ++i) text += kWords[data[i] % std::size(kWords)];
  read(text);
  return 0;
}
