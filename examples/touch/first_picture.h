// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/picture/image_view.h"

struct GreyPicture {
  std::vector<uint8_t> pixels;
  int width = 0, height = 0;
  ptrdiff_t stride_bytes = 0;

  spidar::ImageView view() const { return {pixels.data(), width, height, stride_bytes}; }
};

/// Decodes the first frame of a picture or film with GStreamer, which must be initialised. Throws
/// std::runtime_error that says why there is no picture.
GreyPicture first_picture(const std::string& file);
