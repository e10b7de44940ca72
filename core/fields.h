// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The fields of records that users read. Messages, statistics, traces and the pages of the
/// elements are made from these rows of a name, a unit, a value and a sentence.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Core>

namespace spidar {

/// An int64_t is a time or a duration in ns. GStreamer's times are unsigned: −1 stands for
/// GST_CLOCK_TIME_NONE.
using Scalar = std::variant<bool, int32_t, uint32_t, uint64_t, int64_t, double, const char*>;
/// Values of one row, each with its suffix to the name: separate fields, but in JSON one array.
using Parts = std::vector<std::pair<const char*, Scalar>>;
/// A matrix is one field, an array.
using FieldValue = std::variant<Scalar, Parts, Eigen::MatrixXd>;

/// Returns the coordinates of `vector` as the parts x, y and z.
template <int kSize>
Parts axes(const Eigen::Matrix<double, kSize, 1>& vector) {
  static_assert(kSize == 2 || kSize == 3);
  Parts parts{{"x", vector[0]}, {"y", vector[1]}};
  if constexpr (kSize == 3) parts.emplace_back("z", vector[2]);
  return parts;
}

/// The description of a row. All three strings are literals.
struct Field {
  const char* name;  ///< as in a GstStructure: "stream-time"
  const char* unit;  ///< "" for none
  const char* meaning;

  /// The name in a file, where names have units: "stream_time_ns"; with `part`, "force_x_N".
  std::string column(const char* part = "") const;
};

/// Takes the rows of a record one after the other. Each output derives from this class.
class FieldSink {
 public:
  /// Takes those rows of in() that belong to one of the `outputs`, and all other rows.
  explicit FieldSink(unsigned outputs = 0) : outputs_(outputs) {}
  virtual ~FieldSink() = default;

  void operator()(const char* name, const char* unit, const FieldValue& value,
                  const char* meaning) {
    write({name, unit, meaning}, value);
  }
  /// Adds a row of these outputs only.
  void in(unsigned outputs, const char* name, const char* unit, const FieldValue& value,
          const char* meaning) {
    if ((outputs & outputs_) != 0) write({name, unit, meaning}, value);
  }
  /// Begins a group of rows that end() closes. Only JSON shows groups.
  virtual void begin(const char* /*group*/) {}
  virtual void end() {}

 protected:
  virtual void write(const Field& field, const FieldValue& value) = 0;

 private:
  const unsigned outputs_;
};

/// Appends names or values to a line, with commas between them. Numbers ignore the locale and have
/// only the digits needed to read them back exactly; true is 1.
class CsvLine : public FieldSink {
 public:
  enum class Of { kNames, kValues };
  CsvLine(Of of, std::string& line, unsigned outputs = 0)
      : FieldSink(outputs), of_(of), line_(line), begin_(line.size()) {}

 private:
  void write(const Field& field, const FieldValue& value) override;
  void add(const Field& field, const char* part, const Scalar& scalar);

  const Of of_;
  std::string& line_;
  const size_t begin_;
};

}  // namespace spidar
