// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <string>

#include "plugin/gobject/ref.h"

namespace spidar::screen {

/// A property of a window as XGetWindowProperty() returns it. Any program may set it to anything.
struct Property {
  unsigned long type = 0;
  int bits = 0;             ///< per item: 8, 16 or 32; 0 without the property
  unsigned long count = 0;  ///< of items
  const unsigned char* data = nullptr;
};

/// The items, if they have this type and size: Xlib stores 8-bit items as char, and 32-bit items as
/// long, whatever its size. Otherwise none.
template <typename Items>
Items items_of(const Property& property, unsigned long type) {
  using Item = typename Items::value_type;
  static_assert(sizeof(Item) == sizeof(char) || sizeof(Item) == sizeof(long));
  constexpr int kBits = sizeof(Item) == sizeof(char) ? 8 : 32;
  if (property.type != type || property.bits != kBits || !property.data) return {};
  const auto* const items = reinterpret_cast<const Item*>(property.data);
  return {items, items + property.count};
}

/// Returns the text up to a zero as UTF-8. Other text is read as Latin-1, which accepts any byte.
inline std::string text_of(const std::string& bytes) {
  const std::string text = bytes.c_str();
  if (g_utf8_validate(text.c_str(), -1, nullptr)) return text;
  return taken(g_convert(text.c_str(), -1, "UTF-8", "ISO-8859-1", nullptr, nullptr, nullptr));
}

}  // namespace spidar::screen
