// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Exchange formats of tracks that are in memory, as texts.
#pragma once

#include <string>
#include <vector>

#include "core/track/exchange_formats.h"
#include "core/track/funscript.h"
#include "core/track/keyframes.h"

namespace spidar {

inline SampleSource in_memory(const std::vector<TrackSample>& samples) {
  return {samples.size(), [&samples](const SampleSource::Take& take) {
            for (const TrackSample& sample : samples) take(sample);
          }};
}

inline std::string write_hjif(const std::vector<TrackSample>& samples,
                              double tolerance = kHjifTolerance) {
  std::string text;
  write_hjif(
      in_memory(samples), [&text](const std::string& piece) { text += piece; }, tolerance);
  return text;
}

inline std::string write_funscript(const std::vector<TrackSample>& samples, size_t channel,
                                   double tolerance = kFunscriptTolerance) {
  std::string text;
  write_funscript(
      in_memory(samples), channel, [&text](const std::string& piece) { text += piece; }, tolerance);
  return text;
}

inline std::string write_ahap(const std::vector<TrackSample>& samples,
                              double tolerance = kAhapTolerance) {
  std::string text;
  write_ahap(
      in_memory(samples), [&text](const std::string& piece) { text += piece; }, tolerance);
  return text;
}

inline std::vector<size_t> choose_keyframes(const std::vector<double>& values, double tolerance) {
  std::vector<size_t> chosen;
  KeyframeChooser chooser(tolerance, [&chosen](size_t index, double) { chosen.push_back(index); });
  for (const double value : values) chooser.add(value);
  chooser.finish();
  return chosen;
}

}  // namespace spidar
