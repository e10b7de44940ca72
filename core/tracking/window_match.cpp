// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/tracking/window_match.h"

#include <algorithm>
#include <cmath>

namespace spidar {
namespace {

/// Smaller changes of contrast are ignored, because the estimate is no more accurate.
constexpr float kGainNoticed = 0.1f;
/// Upper limit of compare(), and what it is in the opposite direction.
constexpr float kMostGain = 1.99f;
constexpr float kLeastGain = 1 / kMostGain;

float variance(int64_t sum, int64_t squared, float n) {
  const float mean = static_cast<float>(sum) / n;
  return std::max(0.0f, static_cast<float>(squared) / n - mean * mean);
}

ImagePoint upper_left(ImagePoint centre, int side) {
  const float half = static_cast<float>(side - 1) / 2;
  return {centre.x_px - half, centre.y_px - half};
}

}  // namespace

ReadablePixels::ReadablePixels(const PaddedImage& image)
    : ReadablePixels(image.row(-PaddedImage::kPad_px) - PaddedImage::kPad_px, image.stride(),
                     -PaddedImage::kPad_px, -PaddedImage::kPad_px,
                     image.width() + PaddedImage::kPad_px, image.height() + PaddedImage::kPad_px) {}

ReadablePixels::ReadablePixels(const ImageView& image)
    : ReadablePixels(image.data, image.stride_bytes, 0, 0, image.width, image.height) {}

bool ReadablePixels::source(float x, float y, int columns, int rows, WindowSource& found) const {
  // Treats NaN as outside, before the conversion to an integer.
  if (!(x >= static_cast<float>(x0) && y >= static_cast<float>(y0) &&
        x + static_cast<float>(columns) <= static_cast<float>(x1) &&
        y + static_cast<float>(rows) <= static_cast<float>(y1))) {
    return false;
  }
  const float left = std::floor(x);
  const float top = std::floor(y);
  found.pixels =
      first + (static_cast<ptrdiff_t>(top) - y0) * stride + (static_cast<ptrdiff_t>(left) - x0);
  found.stride = stride;
  found.weights = BilinearWeights::at(x - left, y - top);
  return true;
}

template <int kSide>
bool WindowTemplate<kSide>::read(const ReadablePixels& image, ImagePoint centre) {
  strength_ = 0;
  const ImagePoint begin = upper_left(centre, kSide);
  WindowSource source;
  if (!image.source(begin.x_px - 1, begin.y_px - 1, template_columns(kSide), template_rows(kSide),
                    source)) {
    return false;
  }
  const TemplateSums sums = read_template(source, pixels_);
  constexpr float kPixels = kSide * kSide;
  mean_x_ = static_cast<float>(sums.x) / kPixels;
  mean_y_ = static_cast<float>(sums.y) / kPixels;
  xx_ = static_cast<float>(sums.xx) - mean_x_ * static_cast<float>(sums.x);
  xy_ = static_cast<float>(sums.xy) - mean_x_ * static_cast<float>(sums.y);
  yy_ = static_cast<float>(sums.yy) - mean_y_ * static_cast<float>(sums.y);
  const float determinant = xx_ * yy_ - xy_ * xy_;
  // 1 corresponds to one derivative unit in one pixel; a smaller determinant cannot be inverted.
  if (!(determinant > 1)) return false;
  inverse_determinant_ = 1 / determinant;
  const float difference = xx_ - yy_;
  const float root = std::sqrt(difference * difference + 4 * xy_ * xy_);
  constexpr float kScale = 0.5f / (kPixels * kDerivativeOne * kDerivativeOne);
  strength_ = std::max(0.0f, kScale * (xx_ + yy_ - root));
  contrast_ = std::sqrt(variance(sums.pixel, sums.pixel_squared, kPixels)) / kDifferenceOne;
  return strength_ > 0 && contrast_ > 0;
}

template <int kSide>
float WindowTemplate<kSide>::gain_of(const DifferenceSums& sums) const {
  const float now = std::sqrt(variance(sums.pixel, sums.pixel_squared, kSide * kSide));
  const float gain = now / (kDifferenceOne * contrast_);
  return std::abs(gain - 1) < kGainNoticed ? 1.0f : std::clamp(gain, kLeastGain, kMostGain);
}

template <int kSide>
bool WindowTemplate<kSide>::find(const ReadablePixels& image, const MatchSettings& settings,
                                 WindowMatch& match) const {
  constexpr float kPixels = kSide * kSide;
  const ImagePoint start = match.centre;
  ImagePoint at = start;
  float left = 0;  // residual variance
  float gain = 1;  // ratio of the contrast to the template's
  for (int i = 0; i < settings.iterations; ++i) {
    const ImagePoint begin = upper_left(at, kSide);
    WindowSource source;
    if (!image.source(begin.x_px, begin.y_px, kSide + 1, kSide + 1, source)) return false;
    const auto fixed_gain = static_cast<int>(gain * kGainOne);
    const DifferenceSums sums = compare(source, pixels_, fixed_gain);
    left = variance(sums.difference, sums.squared, kPixels) / (kDifferenceOne * kDifferenceOne);

    const auto difference = static_cast<float>(sums.difference);
    const float bx = static_cast<float>(sums.x) - mean_x_ * difference;
    const float by = static_cast<float>(sums.y) - mean_y_ * difference;
    const float scale = inverse_determinant_ * kDerivativeOne / (kDifferenceOne * gain);
    const float dx = (yy_ * bx - xy_ * by) * scale;
    const float dy = (xx_ * by - xy_ * bx) * scale;
    at.x_px -= dx;
    at.y_px -= dy;
    if (!(std::abs(at.x_px - start.x_px) <= settings.reach_px &&
          std::abs(at.y_px - start.y_px) <= settings.reach_px)) {
      return false;
    }
    if (dx * dx + dy * dy < settings.step_px * settings.step_px) break;
    gain = gain_of(sums);
  }
  match.centre = at;
  match.residual = std::sqrt(left) / (gain * contrast_);
  match.variance_px2 = left / (gain * gain * kPixels * strength_);
  return true;
}

template class WindowTemplate<16>;
template class WindowTemplate<24>;

}  // namespace spidar
