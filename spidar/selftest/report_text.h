// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Numbers for people, and for other programs.
#pragma once

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/json_text.h"

namespace spidar {

/// As std::printf() writes it.
[[gnu::format(printf, 1, 2)]] inline std::string formatted(const char* pattern, ...) {
  va_list values, counted;
  va_start(values, pattern);
  va_copy(counted, values);
  const int length = std::vsnprintf(nullptr, 0, pattern, counted);
  va_end(counted);
  std::string text(static_cast<size_t>(std::max(length, 0)), '\0');
  std::vsnprintf(text.data(), text.size() + 1, pattern, values);
  va_end(values);
  return text;
}

inline Json to_json(const Eigen::Ref<const Eigen::VectorXd>& values) {
  return std::vector<double>(values.data(), values.data() + values.size());
}

}  // namespace spidar
