// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

namespace spidar::filter {

/// Lets a streaming thread analyse one frame, unless the process ends.
///
/// A player may call exit() while its pipeline plays. That destroys the static objects of OpenCV,
/// and a streaming thread that uses them crashes the player. So exit() waits until the frames of
/// all elements are analysed, for one second at most, and from then on no permit is given.
class AnalysisPermit {
 public:
  AnalysisPermit();
  ~AnalysisPermit();
  AnalysisPermit(const AnalysisPermit&) = delete;
  AnalysisPermit& operator=(const AnalysisPermit&) = delete;

  /// False when the process ends: the frame passes unchanged.
  explicit operator bool() const { return is_given_; }

 private:
  bool is_given_;
};

}  // namespace spidar::filter
