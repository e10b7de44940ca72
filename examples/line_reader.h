// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Reads problems as lines of numbers from standard input.
#pragma once

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

/// Calls `use(numbers)` for each line of exactly `count` numbers, which may be infinite or NaN. Any
/// other line is reported on standard error with its number; empty lines and comments, which begin
/// with #, are skipped. Returns the number of bad lines.
template <typename Use>
int for_each_line(std::istream& input, size_t count, Use use) {
  int refused = 0;
  std::string line;
  for (int number = 1; std::getline(input, line); ++number) {
    std::istringstream words(line);
    std::vector<double> numbers;
    std::string word, wrong;
    while (wrong.empty() && words >> word) {
      if (numbers.empty() && word[0] == '#') break;
      char* end = nullptr;
      numbers.push_back(std::strtod(word.c_str(), &end));
      if (*end) wrong = "'" + word + "' is not a number";
    }
    if (wrong.empty() && numbers.empty()) continue;
    if (wrong.empty() && numbers.size() != count)
      wrong =
          std::to_string(count) + " numbers expected, " + std::to_string(numbers.size()) + " found";
    if (wrong.empty()) wrong = use(numbers);
    if (wrong.empty()) continue;
    std::fprintf(stderr, "line %d: %s\n", number, wrong.c_str());
    ++refused;
  }
  return refused;
}
