// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What `spidarctl calibrate` says about a result.
#pragma once

#include <iosfwd>
#include <string>

#include "spidar/calibration/calibration.h"
#include "spidar/profiles/profile.h"

namespace spidar {

/// `how`: like "moved for 20 s".
void print_result(std::ostream& out, const Profile& profile, const CalibrationResult& result,
                  const std::string& how);

/// One JSON object; units are in the names. Infinities are strings.
void print_result_json(std::ostream& out, const Profile& profile, const CalibrationResult& result,
                       const std::string& how);

}  // namespace spidar
