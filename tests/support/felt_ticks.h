// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a haptic trace says of each millisecond, also while it is still written.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace spidar::test {

/// The columns of a haptic trace that tests of players look at.
struct Tick {
  int64_t monotonic_ns = 0;
  int64_t running_ns = 0;
  double force_N = 0;
  bool playing = false;
};

/// Empty while there is no such file.
inline std::vector<Tick> read_trace(const std::string& path) {
  std::ifstream file(path);
  std::string line, field;
  std::map<std::string, size_t> column;
  if (!std::getline(file, line) || file.eof()) return {};
  std::istringstream names(line);
  while (std::getline(names, field, ',')) column.emplace(field, column.size());
  std::vector<Tick> ticks;
  while (std::getline(file, line)) {
    if (file.eof()) break;  // without its end: of a process that was killed, or still writes
    std::vector<std::string> fields;
    std::istringstream row(line);
    while (std::getline(row, field, ',')) fields.push_back(field);
    if (fields.size() < column.size()) break;
    const auto number = [&](const std::string& name) { return std::stod(fields[column.at(name)]); };
    Tick tick;
    tick.monotonic_ns = std::stoll(fields[column.at("monotonic_ns")]);
    tick.running_ns = std::stoll(fields[column.at("running_ns")]);
    tick.force_N = std::hypot(number("commanded_force_x_N"), number("commanded_force_y_N"),
                              number("commanded_force_z_N"));
    tick.playing = number("playing") != 0;
    ticks.push_back(tick);
  }
  return ticks;
}

inline double largest_N(const std::vector<Tick>& ticks) {
  double largest = 0;
  for (const Tick& tick : ticks) largest = std::max(largest, tick.force_N);
  return largest;
}

}  // namespace spidar::test
