// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstring>
#include <gio/gio.h>
#include <optional>
#include <stdexcept>
#include <string>

#include "plugin/gobject/ref.h"

namespace spidar {

/// The lines of a text file that a person or another program has written. Lines end in LF, CR or
/// both. A byte order mark is left out, and UTF-16 with one becomes UTF-8; other bytes stay.
class TextLines {
 public:
  static constexpr const char* kOtherText =
      "is neither UTF-8 nor marked as UTF-16: save it in UTF-8";

  /// Throws std::runtime_error, as next() does, when the file cannot be read.
  explicit TextLines(const std::string& path) : path_(path) {
    const Ref<GFile> file(g_file_new_for_path(path.c_str()));
    Ref<GInputStream> text(G_INPUT_STREAM(g_file_read(file.get(), nullptr, &error_)));
    check();
    text.reset(g_buffered_input_stream_new(Ref<GInputStream>(std::move(text)).get()));
    char mark[3] = "";
    g_buffered_input_stream_fill(G_BUFFERED_INPUT_STREAM(text.get()), -1, nullptr, &error_);
    check();
    g_buffered_input_stream_peek(G_BUFFERED_INPUT_STREAM(text.get()), mark, 0, sizeof mark);
    if (std::memcmp(mark, "\xEF\xBB\xBF", 3) == 0) {
      g_input_stream_skip(text.get(), 3, nullptr, nullptr);
    } else if (std::memcmp(mark, "\xFF\xFE", 2) == 0 || std::memcmp(mark, "\xFE\xFF", 2) == 0) {
      const Ref<GCharsetConverter> to_utf8(g_charset_converter_new("UTF-8", "UTF-16", nullptr));
      text.reset(g_converter_input_stream_new(Ref<GInputStream>(std::move(text)).get(),
                                              G_CONVERTER(to_utf8.get())));
    }
    lines_.reset(g_data_input_stream_new(text.get()));
    g_data_input_stream_set_newline_type(lines_.get(), G_DATA_STREAM_NEWLINE_TYPE_ANY);
  }

  /// Returns the next line without its end; nothing after the last one.
  std::optional<std::string> next() {
    gsize size = 0;
    g_autofree gchar* line = g_data_input_stream_read_line(lines_.get(), &size, nullptr, &error_);
    check();
    return line ? std::optional(std::string(line, size)) : std::nullopt;
  }

 private:
  void check() {
    g_autoptr(GError) error = g_steal_pointer(&error_);
    if (error) throw std::runtime_error(path_ + ": cannot be read: " + error->message);
  }

  const std::string path_;
  GError* error_ = nullptr;
  Ref<GDataInputStream> lines_;
};

}  // namespace spidar
