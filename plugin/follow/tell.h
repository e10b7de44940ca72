// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What is said to people.
#pragma once

#include <string>

#include <glib.h>

namespace spidar {

inline void tell(const std::string& text) {
  g_printerr("spidar-feel: %s\n", text.c_str());
}

}  // namespace spidar
