// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "examples/film/film_uri.h"

#include <filesystem>
#include <stdexcept>

#include <gst/gst.h>

std::string film_uri(const std::string& file_or_uri) {
  namespace fs = std::filesystem;
  if (gst_uri_is_valid(file_or_uri.c_str())) return file_or_uri;
  std::error_code error;
  const fs::file_status status = fs::status(file_or_uri, error);
  if (!fs::exists(status)) {
    throw std::invalid_argument(file_or_uri + ": no such file" +
                                (error && error != std::errc::no_such_file_or_directory
                                     ? " (" + error.message() + ")"
                                     : "") +
                                "; give a video file or a URI such as https://…");
  }
  if (fs::is_directory(status)) {
    throw std::invalid_argument(file_or_uri + ": a folder; give a video file in it");
  }
  if (fs::is_regular_file(status) && fs::file_size(file_or_uri, error) == 0) {
    throw std::invalid_argument(file_or_uri + ": an empty file");
  }
  char* const uri = gst_filename_to_uri(file_or_uri.c_str(), nullptr);
  const std::string result = uri;
  g_free(uri);
  return result;
}
