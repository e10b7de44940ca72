// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stb/stb_image_write.h>

#include "plugin/window/program/panels.h"

namespace spidar {

std::string write_png(const std::vector<uint8_t>& rgb, int width, int height,
                      const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "wbe");
  if (!file) return std::strerror(errno);
  bool complete = true;
  stbi_flip_vertically_on_write(1);
  const auto write = [&](void* data, int size) {
    const auto bytes = static_cast<size_t>(size);
    if (std::fwrite(data, 1, bytes, file) != bytes) complete = false;
  };
  const bool encoded = stbi_write_png_to_func(
                           [](void* context, void* data, int size) {
                             (*static_cast<decltype(write)*>(context))(data, size);
                           },
                           const_cast<void*>(static_cast<const void*>(&write)), width, height, 3,
                           rgb.data(), 3 * width) != 0;
  const bool closed = std::fclose(file) == 0;
  return encoded && complete && closed ? "" : "it cannot be written; is the disk full?";
}

}  // namespace spidar
