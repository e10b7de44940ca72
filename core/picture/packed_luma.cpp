// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/picture/packed_luma.h"

#include <opencv2/imgproc.hpp>

namespace spidar {
namespace {

int conversion(PackedOrder order) {
  switch (order) {
    case PackedOrder::kRgb:
      return cv::COLOR_RGB2GRAY;
    case PackedOrder::kBgr:
      return cv::COLOR_BGR2GRAY;
    case PackedOrder::kRgbx:
      return cv::COLOR_RGBA2GRAY;
    case PackedOrder::kBgrx:
      return cv::COLOR_BGRA2GRAY;
  }
  return cv::COLOR_RGB2GRAY;
}

}  // namespace

ImageView luma_of_packed(const uint8_t* data, int width, int height, ptrdiff_t stride_bytes,
                         PackedOrder order, std::vector<uint8_t>& buffer) {
  const bool padded = order == PackedOrder::kRgbx || order == PackedOrder::kBgrx;
  buffer.resize(static_cast<size_t>(width) * static_cast<size_t>(height));
  // cv::Mat has no const view; nothing writes through this one.
  const cv::Mat source(height, width, padded ? CV_8UC4 : CV_8UC3, const_cast<uint8_t*>(data),
                       static_cast<size_t>(stride_bytes));
  cv::Mat luma(height, width, CV_8UC1, buffer.data());
  cv::cvtColor(source, luma, conversion(order));
  return {buffer.data(), width, height, width};
}

}  // namespace spidar
