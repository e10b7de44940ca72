// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A small window of one picture, found in another (Lucas–Kanade, eq. 2–8).
#pragma once

#include "core/image_view.h"
#include "core/tracking/gray_pyramid.h"
#include "core/tracking/patch_kernels.h"
#include "core/tracking/tracker.h"

namespace spidar {

/// Pixels that may be read; coordinates are those of the picture.
struct ReadablePixels {
  const uint8_t* first;  ///< of column x0 in row y0
  ptrdiff_t stride;
  int x0, y0;  ///< first column and row
  int x1, y1;  ///< first ones outside

  ReadablePixels(const uint8_t* pixels, ptrdiff_t stride_bytes, int left, int top, int right,
                 int bottom)
      : first(pixels), stride(stride_bytes), x0(left), y0(top), x1(right), y1(bottom) {}
  explicit ReadablePixels(const PaddedImage& image);
  /// Of 8 bits.
  explicit ReadablePixels(const ImageView& image);

  /// Whether a window of `columns` × `rows` that begins at `x`, `y` can be read, and its source.
  bool source(float x, float y, int columns, int rows, WindowSource& source) const;
};

struct MatchSettings {
  int iterations = 5;
  float step_px = 0.03f;  ///< a smaller step is the last one
  float reach_px = 6;     ///< further from the start it is another thing
  /// Contrast of the picture over that of the template's; 0: estimate it from the two windows.
  float gain = 1;
};

struct WindowMatch {
  ImagePoint centre;
  /// Standard deviation of what the template does not explain, over its contrast: about √2 for
  /// windows that have nothing to do with each other.
  float residual = 0;
  /// Of the centre along its worse direction, if what is left is noise: residual² / (n λ), px².
  float variance_px2 = 0;
};

/// What a window looks like and how it would change if it moved.
template <int kSide>
class WindowTemplate {
 public:
  /// False when it would reach outside or shows nothing to go by: strength() is 0 then.
  bool read(const ReadablePixels& image, ImagePoint centre);

  /// Smaller eigenvalue of the mean structure tensor about its mean, (grey / px)².
  float strength() const { return strength_; }
  /// That over the larger one: 0 for an edge.
  float roundness() const { return roundness_; }
  /// Standard deviation, grey levels.
  float contrast() const { return contrast_; }

  /// Looks for it in `image` around `match.centre`; its brightness may have changed by any amount.
  /// Inverse-compositional Gauss–Newton (Baker & Matthews, IJCV 56, 2004) on windows without their
  /// mean. False when it leaves the picture or goes too far; `match` is then undefined.
  bool find(const ReadablePixels& image, const MatchSettings& settings, WindowMatch& match) const;

 private:
  float gain_of(const DifferenceSums& sums) const;

  TemplatePixels<kSide> pixels_;
  float xx_ = 0;  ///< Hessian without the part that a change of brightness explains
  float xy_ = 0;
  float yy_ = 0;
  float inverse_determinant_ = 0;
  float mean_x_ = 0;  ///< of the derivatives
  float mean_y_ = 0;
  float strength_ = 0;
  float roundness_ = 0;
  float contrast_ = 0;
};

}  // namespace spidar
