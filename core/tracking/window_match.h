// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Matches a small window of one picture in another (Lucas–Kanade, eq. 2–8).
#pragma once

#include "core/image_view.h"
#include "core/tracking/padded_image.h"
#include "core/tracking/shares.h"
#include "core/tracking/tracker.h"
#include "core/tracking/window_kernels.h"

namespace spidar {

/// A readable area, in coordinates of the picture.
struct ReadablePixels {
  const uint8_t* first;  ///< pixel of column x0 in row y0
  ptrdiff_t stride;
  int x0, y0;  ///< first column and row
  int x1, y1;  ///< exclusive end

  ReadablePixels(const uint8_t* pixels, ptrdiff_t stride_bytes, int left, int top, int right,
                 int bottom)
      : first(pixels), stride(stride_bytes), x0(left), y0(top), x1(right), y1(bottom) {}
  explicit ReadablePixels(const PaddedImage& image);
  /// `image` must have 8 bits.
  explicit ReadablePixels(const ImageView& image);

  /// Sets `source` for a window of `columns` × `rows` that begins at `x`, `y`; returns false if it
  /// cannot be read.
  bool source(float x, float y, int columns, int rows, WindowSource& source) const;
};

struct MatchSettings {
  int iterations = 5;
  float step_px = 0.03f;  ///< the iteration stops after a smaller step
  float reach_px = 6;     ///< largest distance from the start
};

struct WindowMatch {
  ImagePoint centre;
  /// Standard deviation of the difference from the template, relative to its contrast; about √2 for
  /// unrelated windows.
  float residual = 0;
  /// A match that leaves most of the contrast shows something else.
  bool is_same_thing() const { return static_cast<double>(residual) <= kMost; }
  /// Variance of the centre along its less certain direction, assuming that the residual is noise:
  /// residual variance / (n λ), px².
  float variance_px2 = 0;
};

/// The pixels of a window and their derivatives.
template <int kSide>
class WindowTemplate {
 public:
  /// Returns false if the window reaches outside or has no structure; strength() is then 0.
  bool read(const ReadablePixels& image, ImagePoint centre);

  /// Smaller eigenvalue of the mean structure tensor, with the mean gradient subtracted, (grey /
  /// px)².
  float strength() const { return strength_; }

  /// Searches the window in `image` around `match.centre`, for any change of brightness and
  /// contrast. Uses inverse-compositional Gauss–Newton (Baker & Matthews, IJCV 56, 2004) on windows
  /// with their mean subtracted. Returns false if the search leaves the picture or moves too far;
  /// `match` is then undefined.
  bool find(const ReadablePixels& image, const MatchSettings& settings, WindowMatch& match) const;

 private:
  float gain_of(const DifferenceSums& sums) const;

  TemplatePixels<kSide> pixels_;
  float xx_ = 0;  ///< Hessian without the part explained by a change of brightness
  float xy_ = 0;
  float yy_ = 0;
  float inverse_determinant_ = 0;
  float mean_x_ = 0;  ///< mean of the derivatives
  float mean_y_ = 0;
  float strength_ = 0;
  float contrast_ = 0;  ///< standard deviation, grey levels
};

}  // namespace spidar
