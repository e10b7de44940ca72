// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Runs spidartrack as on the command line, and compares its tracks.
#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/track/track_format.h"
#include "tests/support/shell.h"

namespace spidar::test {

/// `text` of the result is what spidartrack printed, both outputs.
inline CommandResult spidartrack(const std::string& arguments) {
  return run(std::string(SPIDARTRACK) + " " + arguments);
}

/// `text` as one word of a shell's command line.
inline std::string shell_word(const std::string& text) {
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

/// Whether something is being written in `folder`.
inline bool has_part_file(const std::filesystem::path& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().filename().string().rfind(".part-", 0) == 0) return true;
  }
  return false;
}

inline void expect_contains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "\"" << part << "\" is not in:\n" << text;
}

inline double largest_difference(const std::vector<TrackSample>& a,
                                 const std::vector<TrackSample>& b) {
  double largest = 0;
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    for (size_t k = 0; k < kTrackChannels; ++k) {
      largest = std::max(largest, std::fabs(static_cast<double>(a[i][k]) - b[i][k]));
    }
  }
  return largest;
}

}  // namespace spidar::test
