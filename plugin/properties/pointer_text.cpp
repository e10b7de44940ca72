// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/properties/pointer_text.h"

#include <glib.h>

namespace spidar {

std::optional<Pointer> parse_pointer(const std::string& text) {
  Pointer pointer;
  if (text == "grip" || text == "mouse") {
    pointer.kind = text == "grip" ? PointerKind::kGrip : PointerKind::kMouse;
    return pointer;
  }
  // Without regard to the locale.
  gchar* end = nullptr;
  const double x = g_ascii_strtod(text.c_str(), &end);
  if (end == text.c_str() || *end != ',') return std::nullopt;
  const char* const second = end + 1;
  const double y = g_ascii_strtod(second, &end);
  if (end == second || *end != '\0') return std::nullopt;
  if (!(x >= 0 && x <= 1 && y >= 0 && y <= 1)) return std::nullopt;
  pointer.place = {x, y};
  return pointer;
}

std::string text_of(const Pointer& pointer) {
  if (pointer.kind == PointerKind::kGrip) return "grip";
  if (pointer.kind == PointerKind::kMouse) return "mouse";
  char x[G_ASCII_DTOSTR_BUF_SIZE], y[G_ASCII_DTOSTR_BUF_SIZE];
  return std::string(g_ascii_formatd(x, sizeof x, "%g", pointer.place.x())) + "," +
         g_ascii_formatd(y, sizeof y, "%g", pointer.place.y());
}

}  // namespace spidar
