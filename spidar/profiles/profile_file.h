// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Converts the text of a profile file to a Profile, and back; profile.h finds the files.
///
/// A profile is TOML. All keys but `source` and `note` are required, others are not allowed:
///
///     description = "…"           one line
///     board = "uart"              DeviceKind::profile_board, or "unknown"
///     dac_bits = 12               8 … 16
///     dac_max_V = 3.3             0 … 60
///     [geometry]
///     frame = "left-handed"       x right, y up, z away from the user; "right-handed": z towards
///     unit = "mm"                 or "m"
///     exit = [[x, y, z], …]       6 to 8 strings, in the order of the board's channels; they hold
///                                 the grip from all sides, in all six motions
///     grip = [[x, y, z], …]       as many, relative to the grip's origin, grip not turned
///     [strings]                   each one number for all strings or an array of one for each
///     min_tension_N = 0.3         at most 3
///     max_tension_N = 6           at most 100, within newtons_per_volt · dac_max_V, and at
///                                 least 16 steps of the D/A
///     newtons_per_volt = 12.5     above zero: signs are below
///     metres_per_count = 2.25e-5  1e-6 … 1e-4
///     motor_sign = [1, …]         an array: 1 where a positive voltage pulls, else -1
///     encoder_sign = [1, …]       an array: 1 where the count rises as string is paid out, else -1
///     [[source]]                  where numbers are from; any number of these
///     fields = ["geometry", …]
///     source = "…"
///     evidence = "published"      inferred, contradicted
///     note = "…"
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "spidar/profiles/profile.h"

namespace spidar {

/// Parses and checks one profile. `path` is only for messages, `name` becomes Profile::name.
/// Left-handed tables are turned into D by z → −z. Throws ProfileError.
Profile parse_profile(const std::string& text, const std::string& path, const std::string& name);

/// Returns TOML from which load_profile() reads exactly the same profile, except for its name,
/// which is that of the file. Geometry is in D and metres.
std::string profile_text(const Profile& profile);

void save_profile(const Profile& profile, const std::string& path);

/// The shipped profiles: TOML by file name, without its ending.
const std::map<std::string, const char*>& shipped_profiles();

}  // namespace spidar
