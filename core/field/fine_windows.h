// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/field/block_field.h"
#include "core/picture/image_view.h"

namespace spidar {

/// Scale and position of a BlockField's picture in its frame.
struct FieldPosition {
  double scale = 1;  ///< px of the frame per px of the field's picture
  /// Centre of the field's picture in the frame, px, where (0, 0) is the centre of the first pixel.
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();
};

/// The motion of a window. Positions are relative to the centre of the field's picture, in its px.
struct FineMotion {
  size_t block = 0;  ///< the block in which the window is now
  Eigen::Vector2d from_px;
  Eigen::Vector2d moved_px;
};

/// Measures in the frame itself how parts of some blocks move. Keeps a small window of the frame
/// for each of these blocks, and finds it in the next frame by Gauss–Newton steps from the motion
/// of its block (inverse compositional: Baker and Matthews: Lucas–Kanade 20 years on, IJCV 2004).
/// The motion of a block is right to a tenth of a pixel of the reduced picture. That of a window is
/// more accurate: the frame has more pixels, and a second step removes the error of the first.
/// Allocates only for the first frame.
class FineWindows {
 public:
  FineWindows();

  /// Keeps windows of `frame` for these blocks of `field`, or for some of them if there are more
  /// than kMax.
  void store(const ImageView& frame, const BlockField& field, const FieldPosition& position,
             const std::vector<size_t>& blocks);

  /// Finds the windows in the next frame, after the update of `field`. Lost windows are left out.
  /// The result is valid until the next call.
  const std::vector<FineMotion>& find(const ImageView& frame, const BlockField& field,
                                      const FieldPosition& position);

  void reset() { windows_.clear(); }

  static constexpr size_t kMax = 48;

 private:
  /// Side of a window, px of the frame: a whole block of a small frame, a part of one of a large
  /// frame.
  static constexpr int kSide_px = kBlock_px;
  /// The largest distance of a window from the position predicted by its block, px of the frame.
  static constexpr int kReach_px = 2;
  static constexpr int kPixels = kSide_px * kSide_px;

  struct Template {
    size_t block = 0;
    int left_px = 0;
    int top_px = 0;
    std::array<float, kPixels> grey;
    std::array<float, kPixels> x_slope;  ///< grey levels per pixel
    std::array<float, kPixels> y_slope;
    Eigen::Matrix2f structure;  ///< Σ g gᵀ of the slopes without their means
    float variance = 0;         ///< of the grey levels
  };

  bool read(const ImageView& frame, Template& window);
  void store_one(const ImageView& frame, const BlockField& field, const FieldPosition& position,
                 size_t block);
  bool step(const Template& window, const Eigen::Vector2f& offset_px, Eigen::Vector2f& step_px,
            float& residual) const;
  bool match(const ImageView& frame, const Template& window, Eigen::Vector2d& moved_px);

  /// Side of a window with kReach_px and one pixel more on each side. The interpolation reads the
  /// pixel to the right and the one below.
  static constexpr int kPatch_px = kSide_px + 2 * kReach_px + 2;
  std::vector<Template> windows_;
  std::vector<FineMotion> found_;
  std::vector<uint8_t> row_;
  std::array<float, kPatch_px * kPatch_px> patch_;
};

}  // namespace spidar
