// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The lines of text files that people or their programs have written.
#pragma once

#include <fstream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <glib.h>

namespace spidar {

/// Lines end in LF, CR or both. A byte order mark is left out, and UTF-16 that has one becomes
/// UTF-8; other bytes are given as they are.
class TextLines {
 public:
  static constexpr const char* kOtherText =
      "is neither UTF-8 nor marked as UTF-16: save it in UTF-8";

  /// Throws std::runtime_error, as next() does, when the file cannot be read.
  explicit TextLines(const std::string& path) : path_(path) {
    char mark[3];
    std::ifstream file(path, std::ios::binary);
    file.read(mark, sizeof mark);
    const std::string begin(mark, static_cast<size_t>(file.gcount()));
    has_mark_ = begin == "\xEF\xBB\xBF";
    const bool is_utf16 = begin.rfind("\xFF\xFE", 0) == 0 || begin.rfind("\xFE\xFF", 0) == 0;
    if (!is_utf16 && begin.find('\0') != std::string::npos) {
      throw std::runtime_error(path + ": " + kOtherText);
    }
    GError* error = nullptr;
    channel_.reset(g_io_channel_new_file(path.c_str(), "r", &error));
    check(error);
    g_io_channel_set_encoding(channel_.get(), is_utf16 ? "UTF-16" : nullptr, nullptr);
  }

  /// Without its end; nothing after the last one.
  std::optional<std::string> next() {
    g_autofree gchar* line = nullptr;
    gsize size = 0;
    GError* error = nullptr;
    g_io_channel_read_line(channel_.get(), &line, nullptr, &size, &error);
    check(error);
    if (!line) return std::nullopt;
    return std::string(line + (std::exchange(has_mark_, false) ? 3 : 0), line + size);
  }

 private:
  void check(GError* error) const {
    const std::unique_ptr<GError, void (*)(GError*)> owned(error, g_error_free);
    if (error) throw std::runtime_error(path_ + ": cannot be read: " + error->message);
  }

  const std::string path_;
  bool has_mark_ = false;
  std::unique_ptr<GIOChannel, void (*)(GIOChannel*)> channel_{nullptr, g_io_channel_unref};
};

}  // namespace spidar
