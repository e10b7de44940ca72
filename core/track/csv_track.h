// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Haptic tracks as CSV: a line for each time, with force in N and torque in N m.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/track/exchange_formats.h"

namespace spidar {

/// Reads the lines of a table one by one, and gives 1000 samples a second: on straight lines
/// between the times of the table, and at rest before the first one.
///
/// The first line may name the columns: time or t, and fx fy fz tx ty tz, of which some may be
/// missing. A unit may follow the name: time_s, time_ms, t_us or t_ns, fx_N, tx_Nm. Other columns
/// are not read. Without names, there are seven columns in this order, and the time is in s. A
/// comma, a semicolon or a tab separates them; after a semicolon, numbers may have a decimal comma.
class CsvTrackReader {
 public:
  explicit CsvTrackReader(SampleSource::Take take) : take_(std::move(take)) {}

  /// The next line, without its end. Throws TrackFileError, which names the line and says what is
  /// wrong with it.
  void add(std::string_view line);
  /// The table has ended. Throws TrackFileError if there is no row in it.
  void finish();

 private:
  /// Returns whether the line names columns.
  bool read_names(std::string_view line);
  [[noreturn]] void fail(const std::string& what) const;

  const SampleSource::Take take_;
  size_t line_ = 0;
  char separator_ = '\0';
  double second_ = 1;  ///< as the times count
  /// The column of the time, and of each channel.
  std::optional<size_t> time_;
  std::array<std::optional<size_t>, kTrackChannels> channels_;
  size_t columns_ = 0;
  // The last row.
  std::optional<double> last_ms_;
  std::array<double, kTrackChannels> last_{};
  size_t next_ms_ = 0;
};

/// Writes a table with the columns time_s, fx_N … tz_Nm, with the digits that a sample has.
void write_csv(const SampleSource& samples, const WriteText& write);

}  // namespace spidar
