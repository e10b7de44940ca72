// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A value as a person writes it.
#pragma once

#include <sstream>
#include <string>

namespace spidar {

/// Numbers have up to six digits, without zeros at the end.
template <typename T>
std::string as_text(const T& value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

}  // namespace spidar
