// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Haptic tracks as CSV: a line for each time, with force in N and torque in N m.
#pragma once

#include <string>

#include "core/track/exchange_formats.h"

namespace spidar::tools {

/// Gives 1000 samples a second of the table in the file `path`: on straight lines from row to row,
/// of which some may have the same time, and at rest before the first one.
///
/// The first line, or a comment before it (# or %), names the columns: time or t, and fx fy fz tx
/// ty tz, of which some may be missing. A unit may follow the name, as in time_ms, "Fx (mN)" or
/// tz/Nmm; without one, it is s, N or N m. Other columns are not read. Without names, there are
/// seven columns in this order. Tabs, semicolons, commas or blanks separate them, and numbers may
/// have a decimal comma. Throws std::runtime_error, which names the line and says what is wrong
/// with it.
void read_csv(const std::string& path, const SampleSource::Take& take);

/// Writes a table with the columns time_s, fx_N … tz_Nm, with the digits that a sample has.
void write_csv(const SampleSource& samples, const WriteText& write);

}  // namespace spidar::tools
