// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/film_frames.h"

#include <cstring>

namespace spidar::bench {

using test::Picture;

std::vector<Picture> draw_all(test::Film& film, int frames) {
  std::vector<Picture> pictures;
  for (int n = 0; n < frames; ++n) {
    const ImageView view = film.draw(n);
    Picture picture(view.width, view.height);
    for (int y = 0; y < view.height; ++y) {
      std::memcpy(&picture.at(0, y), view.data + y * view.stride_bytes,
                  static_cast<size_t>(view.width));
    }
    pictures.push_back(std::move(picture));
  }
  return pictures;
}

}  // namespace spidar::bench
