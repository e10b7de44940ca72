// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/track/exchange_formats.h"
#include "core/track/track_format.h"

namespace spidar {

/// The usual tolerance, as large as the rounding error of a position: half a step of 2 %.
constexpr double kFunscriptTolerance = 0.01;

/// Writes one channel: −1, 0 and 1 become the positions 0, 50 and 100, whole numbers. Players join
/// positions by straight lines, and move at the speed of the lines. The lines differ from the curve
/// by at most `tolerance`, a fraction of the full scale, and the rounding of a position, 0.01.
/// Amplitudes beyond the full scale are clipped, and NaN becomes 0. The script notes its channel
/// and the `gain` by which its samples have been multiplied.
void write_funscript(const SampleSource& samples, size_t channel, const WriteText& write,
                     double tolerance = kFunscriptTolerance, double gain = 1);

/// The latest accepted time of a position: 12 h.
constexpr int64_t kLatestPosition_ms = int64_t{12} * 3600 * 1000;

/// Force and torque of the positions 0 and 100 in other scripts: the usual max-force and
/// max-torque.
constexpr double kScriptForce_N = 3, kScriptTorque_Nm = 0.1;

/// One axis of a funscript: the positions of a device over time, and how they are felt.
struct ScriptAxis {
  struct Point {
    int64_t at_ms;
    double fraction;  ///< of the range between the positions 0 and 100
  };

  std::string name;           ///< in the script: "R1", "roll"; empty: the axis of its own actions
  size_t channel = 0;         ///< of a track
  double gain = 1;            ///< of the samples, when the script was written
  bool is_noted = false;      ///< whether channel and gain are those of write_funscript()
  std::vector<Point> points;  ///< in order of time; empty: the axis is at rest

  /// A sample of the track, along straight lines; zero before the first and after the last
  /// position.
  float at(int64_t time_ms) const;
};

/// The channel of an axis such as "roll" or "R1", ignoring case, as players of several axes name
/// them: L0 stroke up, L1 surge forwards, L2 sway sideways, R0 twist about the vertical, R1 roll
/// about forwards, R2 pitch about sideways. Nothing for other names.
///
/// Source: the README and default settings of MultiFunPlayer; OFS-NG calls its files
/// film.R1.funscript (issue 2 of ofs69/ofs-ng).
std::optional<size_t> channel_of_axis(std::string_view name);
/// Whether `name` is an axis of those players without force and torque: "vib", "V0", "suck" …
bool is_other_axis(std::string_view name);

struct Funscript {
  std::vector<ScriptAxis> axes;     ///< one for each channel, the actions of the script first
  std::vector<std::string> others;  ///< names of axes that cannot be felt
};

/// Reads a script. `channel` is that of its own actions, unless the script notes another one. Also
/// reads the axes of versions 1.1 ("axes": [{"id":"R1","actions":…}]) and 2.0
/// ("channels":{"roll":{"actions":…}}). Positions are sorted, and of two at one time the later one
/// counts, as in players. "range" is the used percentage of the full scale: launchcontrol, the
/// player from which the format comes, scales the positions by it, and its usual limits put them
/// about the middle. As there, a range of 0 or none at all means 100. Throws TrackFileError for a
/// text that is not JSON, missing actions (they may be empty), and a number out of its range.
Funscript parse_funscript(const std::string& text, size_t channel);

}  // namespace spidar
