// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/track/motion_sidecar.h"

#include <fstream>

#include "plugin/track/beside_film.h"

namespace spidar {
std::string motion_end(const MotionPiece& piece) {
  if (piece.of == 0) return kMotionEnd;
  return "." + std::to_string(piece.number) + "of" + std::to_string(piece.of) + kMotionEnd;
}

std::string find_analysis(const std::string& film) {
  return find_beside(film, {kMotionEnd});
}

MotionFile read_motion_file(const std::string& path) {
  std::ifstream file = open_regular_file(path);
  return MotionFile(file);
}

MotionHeader read_motion_header(const std::string& path) {
  std::ifstream file = open_regular_file(path);
  return read_header(file);
}

}  // namespace spidar
