// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/spelling.h"

#include <algorithm>
#include <numeric>

namespace spidar {
namespace {

/// How many letters must be added, left out or replaced (V. I. Levenshtein, 1966).
size_t edits(const std::string& from, const std::string& to) {
  std::vector<size_t> row(to.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 0; i < from.size(); ++i) {
    size_t diagonal = row[0]++;
    for (size_t j = 0; j < to.size(); ++j) {
      const size_t replaced = diagonal + (from[i] != to[j]);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, diagonal + 1, row[j] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string meant(const std::string& word, const std::vector<std::string>& known) {
  std::string nearest;
  // A quarter of the letters may be wrong.
  size_t fewest = std::max<size_t>(1, word.size() / 4) + 1;
  for (const std::string& name : known) {
    const size_t needed = edits(word, name);
    if (needed < fewest) nearest = name;
    fewest = std::min(fewest, needed);
  }
  return nearest.empty() ? "" : "; did you mean " + nearest + "?";
}

}  // namespace spidar
