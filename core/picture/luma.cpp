// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/picture/luma.h"

#include <cstring>

#include <opencv2/imgproc.hpp>

#include "core/picture/luma_words.h"
#include "core/picture/opencv.h"

namespace spidar {

void copy_row(const ImageView& frame, int x, int y, int columns, uint8_t* to) {
  const uint8_t* from = frame.at(x, y);
  if (frame.sample.bytes == 1) {
    std::memcpy(to, from, static_cast<size_t>(columns));
    return;
  }
  with_reader(frame.sample, [&](const auto& reader) {
    constexpr int kLanes = 16;
    const auto copy = [&](int k) { cv::v_store(to + k, reader.load(from + k * reader.kBytes)); };
    if (columns < kLanes) {
      for (int k = 0; k < columns; ++k) {
        to[k] = static_cast<uint8_t>(reader.at(from + k * reader.kBytes));
      }
    } else {
      for (int k = 0; k + kLanes <= columns; k += kLanes) copy(k);
      copy(columns - kLanes);  // the rest, overlapping pixels already copied
    }
  });
}

ImageView in_8_bits(const ImageView& frame, std::vector<uint8_t>& buffer) {
  if (frame.sample.bytes == 1) return frame;
  const auto width = static_cast<size_t>(frame.width);
  buffer.resize(width * static_cast<size_t>(frame.height));
  for (int y = 0; y < frame.height; ++y) {
    copy_row(frame, 0, y, frame.width, buffer.data() + static_cast<size_t>(y) * width);
  }
  return {buffer.data(), frame.width, frame.height, frame.width};
}

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
  const int type = padded ? CV_8UC4 : CV_8UC3;
  cv::Mat luma(height, width, CV_8UC1, buffer.data());
  cv::cvtColor(const_mat(data, width, height, type, stride_bytes), luma, conversion(order));
  return {buffer.data(), width, height, width};
}

}  // namespace spidar
