// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// motion-features WIDTH HEIGHT FRAMES [FPS]: reads films of FRAMES pictures of raw luma, one byte a
// pixel, one after the other, until there is no more; writes for each picture one byte: 1 if it was
// compared with the one before, or 0. If it was, for each block, row by row:
//   kFeatures × float16  features, see block_features.h
//   int16                block of the picture before from which it has come
//   uint8                bit 0: it moves, by the present rules; bit 1: the camera's motion is known
// A block is kBlock_px of the picture in which motion is measured; the first line on stderr tells
// "rows columns features". Numbers are those of the processor.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "core/motion/motion_estimator.h"

namespace spidar {
namespace {

/// IEEE 754 half precision, rounded to the nearest; for |x| ≤ kMostFeature.
uint16_t half(float x) {
  uint32_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  const auto sign = static_cast<uint16_t>((bits >> 16) & 0x8000);
  bits &= 0x7fffffff;
  constexpr uint32_t kLeastNormal = 0x38800000;  // 2⁻¹⁴
  if (bits < kLeastNormal) {                     // in steps of 2⁻²⁴
    std::memcpy(&x, &bits, sizeof x);
    return sign | static_cast<uint16_t>(x * 16777216 + 0.5f);
  }
  bits += 0xfff + ((bits >> 13) & 1);
  return sign | static_cast<uint16_t>((bits - 0x38000000) >> 13);
}

class Records {
 public:
  void write(const MotionEstimator& motion, const BlockFeatures& features, bool is_known) {
    const size_t n = features.origins().size();
    bytes_.clear();
    for (size_t i = 0; i < n; ++i) {
      for (int k = 0; k < kFeatures; ++k) {
        add(half(features.values()[i * kFeatures + static_cast<size_t>(k)]));
      }
      add(static_cast<int16_t>(features.origins()[i]));
      add(static_cast<uint8_t>((motion.moves(i) ? 1 : 0) | (is_known ? 2 : 0)));
    }
    std::fwrite(bytes_.data(), 1, bytes_.size(), stdout);
  }

 private:
  template <typename Value>
  void add(Value value) {
    const size_t end = bytes_.size();
    bytes_.resize(end + sizeof value);
    std::memcpy(&bytes_[end], &value, sizeof value);
  }

  std::vector<uint8_t> bytes_;
};

/// False at the end of the films.
bool measure_film(int width, int height, int frames, int64_t interval_ns,
                  std::vector<uint8_t>& luma, Records& records) {
  MotionEstimator motion;
  motion.moving_blocks().keep_features();
  ReducedFrame reduced;
  MeasuredFrame frame;
  static bool is_told = false;
  for (int k = 0; k < frames; ++k) {
    if (std::fread(luma.data(), 1, luma.size(), stdin) != luma.size()) return false;
    const ImageView view{luma.data(), width, height, width};
    if (reduced.read(view) == PictureKind::kFirst) motion.reset();
    frame.interval_ns = interval_ns;
    const bool is_compared = motion.estimate(view, reduced, frame);
    std::putchar(is_compared ? 1 : 0);
    if (!is_compared) continue;
    if (!is_told) {
      std::fprintf(stderr, "%d %d %d\n", motion.grid().rows, motion.grid().columns, kFeatures);
      is_told = true;
    }
    records.write(motion, motion.moving_blocks().features(), frame.background->is_known);
  }
  return true;
}

}  // namespace
}  // namespace spidar

int main(int argc, char** argv) {
  const int width = argc > 1 ? std::atoi(argv[1]) : 0;
  const int height = argc > 2 ? std::atoi(argv[2]) : 0;
  const int frames = argc > 3 ? std::atoi(argv[3]) : 0;
  const double fps = argc > 4 ? std::atof(argv[4]) : 24;
  if (width < 32 || height < 32 || frames < 1 || !(fps > 0)) {
    std::fprintf(
        stderr,
        "motion-features WIDTH HEIGHT FRAMES [FPS] < LUMA > RECORDS: width and height are at "
        "least 32 px, frames at least 1, and fps is positive\n");
    return 2;
  }
  std::vector<uint8_t> luma(static_cast<size_t>(width) * static_cast<size_t>(height));
  static char out[1 << 20];
  std::setvbuf(stdout, out, _IOFBF, sizeof out);
  spidar::Records records;
  const auto interval_ns = static_cast<int64_t>(1e9 / fps);
  while (spidar::measure_film(width, height, frames, interval_ns, luma, records)) {
  }
  return std::fflush(stdout) == 0 ? 0 : 1;
}
