// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/frame/frame_report.h"

namespace spidar {

const char* to_string(FrameProblem problem) {
  switch (problem) {
    case FrameProblem::kNone:
      return "no problem";
    case FrameProblem::kNoTimestamp:
      return "it has no timestamp";
    case FrameProblem::kSameTimestamp:
      return "its timestamp is equal or nearly equal to that of the previous frame";
    case FrameProblem::kFallingTimestamp:
      return "its timestamp is earlier than that of the previous frame";
    case FrameProblem::kTooSmall:
      return "it has less memory than its picture needs";
    case FrameProblem::kNotShown:
      return "it is outside the segment or cropped to nothing";
    case FrameProblem::kSmallHalf:
      return "the half of it that is picture is too small";
  }
  return "unknown problem";
}

}  // namespace spidar
