// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "apps/study/terminal.h"

#include <string>

namespace study {

int ask(const Question& question, std::istream& in, std::ostream& out) {
  out << question.text << "\n ";
  for (int step = 1; step <= kSteps; ++step) out << ' ' << step << ' ' << step_name(step) << ' ';
  out << "\n";
  for (std::string line; out << "> " << std::flush, std::getline(in, line);) {
    if (line == "q") return 0;
    if (line.size() == 1 && line[0] >= '1' && line[0] < '1' + kSteps) return line[0] - '0';
    out << "a number from 1 to " << kSteps << ", or q to stop here and go on another time\n";
  }
  return 0;
}

bool wait_for_return(std::istream& in, std::ostream& out) {
  out << "return: play, q: stop here and go on another time > " << std::flush;
  std::string line;
  return std::getline(in, line) && line != "q";
}

}  // namespace study
