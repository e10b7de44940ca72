// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Properties of windows, which any program may set to anything.
#pragma once

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "plugin/gobject/ref.h"

namespace spidar::screen {

/// A property as XGetWindowProperty() gives it.
struct Property {
  unsigned long type = 0;
  int bits = 0;             ///< of an item: 8, 16 or 32; 0 without the property
  unsigned long count = 0;  ///< of items
  const unsigned char* data = nullptr;
};

/// Its items, where it has this type and items of this size: 8 bits are a char, 32 are a long,
/// however long that is. Otherwise none.
template <typename Item>
std::vector<Item> items_of(const Property& property, unsigned long type) {
  static_assert(sizeof(Item) == sizeof(char) || sizeof(Item) == sizeof(long));
  constexpr int kBits = sizeof(Item) == sizeof(char) ? 8 : 32;
  std::vector<Item> items;
  if (property.type != type || property.bits != kBits || !property.data) return items;
  items.resize(property.count);
  if (!items.empty()) std::memcpy(items.data(), property.data, items.size() * sizeof(Item));
  return items;
}

/// As UTF-8, up to a zero. What is none is taken for Latin-1, as which every byte is a letter.
inline std::string text_of(const std::vector<char>& bytes) {
  const std::string text(bytes.begin(), std::find(bytes.begin(), bytes.end(), '\0'));
  if (g_utf8_validate(text.c_str(), -1, nullptr)) return text;
  return taken(g_convert(text.c_str(), -1, "UTF-8", "ISO-8859-1", nullptr, nullptr, nullptr));
}

}  // namespace spidar::screen
