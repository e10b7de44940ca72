// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The tables of a motion file as compressed columns.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/analysis/motion_rows.h"

namespace spidar {

/// A column by name. One that consists of zeros is left out.
using MotionColumns = std::map<std::string, std::vector<uint8_t>>;

/// Each number of a column but the first is its difference from the one before, where that is
/// usually small; then come the lowest bytes of all numbers, then the next bytes; all are deflated
/// (RFC 1950).
MotionColumns pack_columns(const MotionRows& rows);

/// The inverse, for so many rows. False when a column is not what was packed.
bool unpack_columns(const MotionColumns& columns, size_t frames, size_t objects, MotionRows& rows);

}  // namespace spidar
