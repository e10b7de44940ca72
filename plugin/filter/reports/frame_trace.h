// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A file with one line for each frame, to be looked at later.
#pragma once

#include <cstdint>
#include <string>

#include "plugin/frame/frame_report.h"
#include "spidar/realtime/line_writer.h"

namespace spidar::filter {

/// One JSON object and a line end. Keys carry their units; positions are pixels from the centre of
/// the frame, x right, y down:
///
///     running_time_ns, stream_time_ns, interval_ns, left_px, top_px, width_px, height_px,
///     restarted, repeated, features, object, motion: {velocity_px_s: [x, y], growth_1_s,
///     roll_rad_s, tracked}, wrench: {force_N: [x, y, z], torque_Nm: [x, y, z]}, background:
///     {model, shift_px, linear: [[xx, xy], [yx, yy]], perspective_1_px, sigma_px,
///                  coverage} or null,
///     objects: [{id, position_px, size_px, velocity_px_s, error_px_s, on_screen_px_s, growth_1_s,
///                roll_rad_s, model, points, prominence}, …]
///
/// (see ImageMotion, MotionModel and MovingObject; an object's velocity is against the background).
/// `repeated`: the frame shows the previous picture again, and all other values are those of that
/// picture. Numbers have as few digits as can be read back exactly. A number that is not finite
/// becomes null, because JSON cannot express it.
std::string json_line(const Frame& frame);

/// Writes CSV with a header line where the name ends in .csv; where it ends in .jsonl, what
/// json_line() gives, with objects and background; numbers are written without regard to the
/// locale, with the digits that reading them back needs.
class FrameTrace {
 public:
  /// Returns an empty string, or the reason why the file cannot be written.
  std::string open(const std::string& path);

  /// Does not wait for the file. Returns errno of the write that ended the trace; 0 if none did.
  int write(const FrameReport& report);

  /// Writes the last rows, as far as they are taken.
  LineWriter::Status close() { return file_.close(); }

 private:
  void append_csv(const FrameReport& report);

  LineWriter file_;
  bool is_json_ = false;
  std::string line_;  ///< of the previous frame; its memory is reused
};

}  // namespace spidar::filter
