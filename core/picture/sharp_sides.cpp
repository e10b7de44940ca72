// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/picture/sharp_sides.h"

#include <algorithm>
#include <cstdlib>

namespace spidar {
namespace {

/// A film is this many times sharper than what is beside it in three quarters of the bands: lines
/// of bold letters over a film are in half of them. A blur of σ = 1 px divides the sharpness of a
/// texture whose amplitudes are those of natural pictures, 1 / f, by 6.0, and enlarging it as far
/// as an upright film is, by 7.7; coding noise, which both sides have, takes a part of that.
constexpr float kSharper = 3;
/// Sharpness of a plain picture after coding, grey levels.
constexpr float kPlainSharpness_grey = 0.15F;
/// A side is a bar if the means of its neighbouring bands differ by less than this, grey levels.
constexpr int kBar_grey = 1;
constexpr int kBand_px = 8;
constexpr int kLine_px = 4;  ///< distance between the examined lines of a band
/// The width of the strips that are compared on both sides of a seam, and their distance from it: a
/// seam is as sharp as a film.
constexpr int kStrip_px = 16;
constexpr int kSeam_px = 2;
/// The widest side, as a fraction of the picture.
constexpr double kWidest = 0.4;

}  // namespace

/// Measures sharpness and brightness along bands that lead from one side to the other.
void SharpSides::measure(const ImageView& picture, bool are_beside) {
  length_ = are_beside ? picture.width : picture.height;
  bands_ = (are_beside ? picture.height : picture.width) / kBand_px;
  const ptrdiff_t along = are_beside ? 1 : picture.stride_bytes;
  const ptrdiff_t across = are_beside ? picture.stride_bytes : 1;
  // The size serves both ways, so that the second measurement needs no more memory.
  sums_.resize(static_cast<size_t>((picture.width + kBand_px) * (picture.height + kBand_px)) /
               kBand_px);
  for (int band = 0; band < bands_; ++band) {
    Sums* const sums = &sums_[static_cast<size_t>(band * length_)];
    sums[0] = {};
    for (int i = 1; i + 1 < length_; ++i) {
      Sums sum = sums[i - 1];
      for (int j = kLine_px / 2; j < kBand_px; j += kLine_px) {
        const uint8_t* const at = picture.data + i * along + (band * kBand_px + j) * across;
        sum.sharpness += std::abs(4 * *at - at[-along] - at[along] - at[-across] - at[across]);
        sum.grey += *at;
      }
      sums[i] = sum;
    }
  }
}

SharpSides::Sums SharpSides::strip(int band, int from) const {
  const Sums* const before = &sums_[static_cast<size_t>(band * length_ + from - 1)];
  return {before[kStrip_px].sharpness - before[0].sharpness,
          before[kStrip_px].grey - before[0].grey};
}

/// How many times sharper the strip that begins at `inside` is than the strip that begins at
/// `outside`; 0 if the strip outside is a bar.
float SharpSides::sharper(int inside, int outside) {
  constexpr int kCount = kStrip_px * kBand_px / kLine_px;
  constexpr float kPlain = 4 * kPlainSharpness_grey * kCount;
  ratios_.clear();
  int steps = 0;
  for (int band = 0; band < bands_; ++band) {
    const Sums in = strip(band, inside), out = strip(band, outside);
    ratios_.push_back((static_cast<float>(in.sharpness) + kPlain) /
                      (static_cast<float>(out.sharpness) + kPlain));
    if (band > 0) steps += std::abs(out.grey - strip(band - 1, outside).grey);
  }
  if (steps < kBar_grey * kCount * (bands_ - 1)) return 0;
  const auto quarter = ratios_.begin() + bands_ / 4;
  std::nth_element(ratios_.begin(), quarter, ratios_.end());
  return *quarter;
}

/// Returns the width of two equal sides; 0 if there are none.
int SharpSides::side_width(const ImageView& picture, bool are_beside) {
  measure(picture, are_beside);
  int best = 0;
  float most = kSharper;
  for (int at = kStrip_px + kSeam_px + 1; at < kWidest * length_; ++at) {
    const float first = sharper(at + kSeam_px, at - kSeam_px - kStrip_px);
    if (first < most) continue;
    const int end = length_ - at;
    const float last = sharper(end - kSeam_px - kStrip_px, end + kSeam_px);
    if (last < most) continue;
    most = std::min(first, last);
    best = at + kSeam_px;
  }
  return best;
}

std::optional<PicturePart> SharpSides::find(const ImageView& picture) {
  constexpr int kLeast_px = 6 * kStrip_px;
  if (picture.width < kLeast_px || picture.height < kLeast_px) return std::nullopt;
  const int beside = side_width(picture, true);
  if (beside > 0) return PicturePart{beside, 0, picture.width - 2 * beside, picture.height};
  const int above = side_width(picture, false);
  if (above > 0) return PicturePart{0, above, picture.width, picture.height - 2 * above};
  return std::nullopt;
}

}  // namespace spidar
