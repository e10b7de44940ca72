// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/tracking/middlebury.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "tests/bench/tracking/film_frames.h"

namespace spidar::bench {

std::optional<Eigen::Vector2d> FlowField::at(double x_px, double y_px) const {
  constexpr float kUnknown = 1e9f;  // as the format has it
  const int x = static_cast<int>(std::floor(x_px));
  const int y = static_cast<int>(std::floor(y_px));
  if (x < 0 || y < 0 || x + 1 >= width || y + 1 >= height) return {};
  Eigen::Vector2d sum(0, 0);
  for (int k = 0; k < 4; ++k) {
    const size_t index = 2 * (static_cast<size_t>(y + k / 2) * static_cast<size_t>(width) +
                              static_cast<size_t>(x + k % 2));
    const Eigen::Vector2f flow(xy_px[index], xy_px[index + 1]);
    if (!(flow.cwiseAbs().maxCoeff() < kUnknown)) return {};
    const double wx = k % 2 != 0 ? x_px - x : 1 - (x_px - x);
    const double wy = k / 2 != 0 ? y_px - y : 1 - (y_px - y);
    sum += wx * wy * flow.cast<double>();
  }
  return sum;
}

FlowField read_flow(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error(file + ": cannot be read");
  // Little-endian, as the machines are that this runs on.
  float magic = 0;
  int32_t size[2] = {};
  in.read(reinterpret_cast<char*>(&magic), sizeof magic);
  in.read(reinterpret_cast<char*>(size), sizeof size);
  constexpr int32_t kLargest = 1 << 14;
  if (!in || magic != 202021.25f || *std::min_element(size, size + 2) < 1 ||
      *std::max_element(size, size + 2) > kLargest) {
    throw std::runtime_error(file + ": is no .flo file: it begins with 202021.25, width, height");
  }
  FlowField field;
  field.width = size[0];
  field.height = size[1];
  field.xy_px.resize(2 * static_cast<size_t>(size[0]) * static_cast<size_t>(size[1]));
  in.read(reinterpret_cast<char*>(field.xy_px.data()),
          static_cast<std::streamsize>(field.xy_px.size() * sizeof(float)));
  if (!in) throw std::runtime_error(file + ": ends too early");
  return field;
}

std::vector<FlowPair> read_pairs(const std::string& folder) {
  if (!std::filesystem::is_directory(folder)) {
    throw std::runtime_error(folder + ": is not a folder");
  }
  std::vector<std::filesystem::path> folders;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (std::filesystem::exists(entry.path() / "flow10.flo")) folders.push_back(entry.path());
  }
  if (folders.empty()) {
    throw std::runtime_error(folder +
                             ": no folder with frame10.png, frame11.png, flow10.flo in it");
  }
  std::sort(folders.begin(), folders.end());
  std::vector<FlowPair> pairs;
  for (const std::filesystem::path& path : folders) {
    FlowPair pair{path.filename().string(), read_picture(path / "frame10.png"),
                  read_picture(path / "frame11.png"), read_flow(path / "flow10.flo")};
    if (pair.before.width != pair.truth.width || pair.before.height != pair.truth.height) {
      throw std::runtime_error(path.string() + ": pictures and flow differ in size");
    }
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

}  // namespace spidar::bench
