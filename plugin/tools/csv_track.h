// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <string>

#include "core/track/exchange_formats.h"

namespace spidar::tools {

/// Reads a haptic track from the CSV file `path` and passes 1000 samples a second to `take`. The
/// values are interpolated linearly between the rows, of which some may have the same time, and are
/// zero before the first row.
///
/// The first line, or a comment before it (# or %), names the columns: time or t, and fx fy fz tx
/// ty tz, of which some may be missing. A unit may follow the name, as in time_ms, "Fx (mN)" or
/// tz/Nmm; the defaults are s, N and N m. Other columns are ignored. Without names, there are seven
/// columns in this order. Tabs, semicolons, commas or blanks separate them, and numbers may have a
/// decimal comma. Throws std::runtime_error, which names the line and says what is wrong.
void read_csv(const std::string& path, const SampleSource::Take& take);

/// Writes a table with the columns time_s, fx_N … tz_Nm, with the digits of a sample.
void write_csv(const SampleSource& samples, const WriteText& write);

}  // namespace spidar::tools
