// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A row of a trace.
#pragma once

#include <string>
#include <string_view>

#include "core/number_text.h"
#include "core/wrench.h"

namespace spidar {

/// Appends fields, and the commas between them, to what `csv` has. Numbers are written without
/// regard to the locale, as short as possible to be read back exactly.
class CsvRow {
 public:
  explicit CsvRow(std::string& csv) : csv_(csv), begin_(csv.size()) {}

  template <typename Number>
  CsvRow& number(Number value) {
    return field(NumberText(value));
  }
  CsvRow& field(std::string_view text) {
    if (csv_.size() > begin_) csv_ += ',';
    csv_ += text;
    return *this;
  }
  CsvRow& vector(const Eigen::Vector3d& v) { return number(v.x()).number(v.y()).number(v.z()); }
  CsvRow& wrench(const Wrench& w) { return vector(w.force_N).vector(w.torque_Nm); }

 private:
  std::string& csv_;
  size_t begin_;
};

}  // namespace spidar
