// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/analysis/square_pixel_resampler.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "core/picture/luma.h"
#include "core/picture/opencv.h"

namespace spidar {

int SquarePixelResampler::width_of(int stored_width, double pixel_aspect) {
  return std::max(1, static_cast<int>(std::lround(stored_width * pixel_aspect)));
}

ImageView SquarePixelResampler::view(const ImageView& picture, double pixel_aspect) {
  if (pixel_aspect == 1) return picture;
  const int width = width_of(picture.width, pixel_aspect);
  const ImageView from = in_8_bits(picture, eight_bits_);
  resampled_.resize(static_cast<size_t>(width) * static_cast<size_t>(picture.height));
  cv::Mat square(picture.height, width, CV_8U, resampled_.data());
  run_on_this_thread([&] {
    cv::resize(const_mat(from), square, square.size(), 0, 0,
               width > from.width ? cv::INTER_LINEAR : cv::INTER_AREA);
  });
  return {resampled_.data(), width, picture.height, width};
}

PicturePart in_square_pixels(const PicturePart& area, int width, int square_width) {
  if (width == square_width) return area;
  const double fraction = static_cast<double>(square_width) / width;
  const auto scaled = [&](int x) { return static_cast<int>(std::lround(x * fraction)); };
  const int left = scaled(area.x);
  return {left, area.y, scaled(area.x + area.width) - left, area.height};
}

void to_stored_pixels(Frame& frame, int width) {
  FilmPlace& place = frame.place;
  if (place.picture_width == width || place.picture_width == 0) return;
  const double fraction = static_cast<double>(width) / place.picture_width;
  place.area = in_square_pixels(place.area, place.picture_width, width);
  place.picture_width = width;
  const auto narrow = [&](Eigen::Vector2d& along) { along.x() *= fraction; };
  narrow(frame.motion.velocity_px_s);
  for (FollowedPoint& point : frame.points) {
    for (ImagePoint* end : {&point.from, &point.to}) {
      // The corner of the picture, at (−½, −½), stays in place.
      end->x_px = (end->x_px + 0.5f) * static_cast<float>(fraction) - 0.5f;
    }
  }
  if (frame.background) {
    MotionModel& model = frame.background->model;
    narrow(model.shift_px);
    model.linear(0, 1) *= fraction;
    model.linear(1, 0) /= fraction;
    model.perspective_1_px.x() /= fraction;
  }
  for (MovingObject& object : frame.objects) {
    for (Eigen::Vector2d* along :
         {&object.position_px, &object.size_px, &object.low_off_px, &object.high_off_px,
          &object.relative_px_s, &object.on_screen_px_s}) {
      narrow(*along);
    }
    object.area_px2 *= fraction;
    object.error_px_s *= std::max(fraction, 1.0);  // in the direction of the larger error
  }
}

}  // namespace spidar
