// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/field/combing.h"

#include <array>

#include "core/field/block_kernels.h"
#include "core/picture/luma.h"
#include "core/picture/opencv.h"
#include "core/picture/padded_image.h"

namespace spidar {
namespace {

/// In a comb, brightness changes by more than kComb_grey from one line to the next and returns to
/// within kSame_grey on the line after. Noise of σ = 5 grey levels does so in 2 of 100 000 pixels.
constexpr int kComb_grey = 20;
constexpr int kSame_grey = kComb_grey / 2;
/// A frame counts as combed if at least this fraction of its pixels shows combs: as many as an
/// object on 5 % of the frame has with combs on one of its pixels in ten.
constexpr double kCombed = 0.005;
/// For how many frames a film counts as interlaced after a combed frame: ten seconds at 24
/// frames/s, because parts of a film are still.
constexpr int kFrames = 240;

constexpr int kLines = 4;
/// Of this many lines of the frame, kLines are examined, to save time. Every block covers at least
/// this many lines, so a part of every block is examined.
constexpr int kEvery = kBlock_px;

/// Pixels are compared in vectors. The padding of the last one shows no comb: all lines have 0.
constexpr int kLanes = 16;

int combs_in(const std::array<const uint8_t*, kLines>& lines, int width) {
  const cv::v_uint8x16 comb = cv::v_setall_u8(kComb_grey);
  const cv::v_uint8x16 same = cv::v_setall_u8(kSame_grey);
  const cv::v_uint8x16 one = cv::v_setall_u8(1);
  unsigned combs = 0;
  for (int x = 0; x < width; x += kLanes) {
    const cv::v_uint8x16 a = cv::v_load(lines[0] + x);
    const cv::v_uint8x16 b = cv::v_load(lines[1] + x);
    const cv::v_uint8x16 c = cv::v_load(lines[2] + x);
    const cv::v_uint8x16 d = cv::v_load(lines[3] + x);
    const cv::v_uint8x16 returns = (cv::v_absdiff(a, c) <= same) & (cv::v_absdiff(b, d) <= same);
    // Subtraction of 8-bit lanes saturates at 0.
    const cv::v_uint8x16 up = (b - a > comb) & (d - c > comb);
    const cv::v_uint8x16 down = (a - b > comb) & (c - d > comb);
    combs += cv::v_reduce_sum(returns & (up | down) & one);
  }
  return static_cast<int>(combs);
}

}  // namespace

double comb_fraction(const ImageView& frame, std::vector<uint8_t>& memory) {
  const auto width = static_cast<size_t>((frame.width + kLanes - 1) / kLanes * kLanes);
  memory.assign(kLines * width, 0);
  int64_t combs = 0;
  int64_t pixels = 0;
  for (int y = kEvery / 2; y + kLines <= frame.height; y += kEvery) {
    std::array<const uint8_t*, kLines> lines;
    for (size_t k = 0; k < kLines; ++k) {
      uint8_t* line = memory.data() + k * width;
      copy_row(frame, 0, y + static_cast<int>(k), frame.width, line);
      lines[k] = line;
    }
    combs += combs_in(lines, frame.width);
    pixels += frame.width;
  }
  return pixels > 0 ? static_cast<double>(combs) / static_cast<double>(pixels) : 0;
}

bool Combing::update(const ImageView& frame) {
  if (row_step(halving_factor(frame.width, frame.height)) > 1) return false;
  if (comb_fraction(frame, lines_) >= kCombed) {
    frames_left_ = kFrames;
  } else if (frames_left_ > 0) {
    --frames_left_;
  }
  return frames_left_ > 0;
}

}  // namespace spidar
