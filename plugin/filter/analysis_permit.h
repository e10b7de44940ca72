// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

namespace spidar::filter {

/// Permits a streaming thread to analyse one frame, unless the process is exiting.
///
/// A player may call exit() while its pipeline plays. exit() destroys the static objects of OpenCV,
/// and a streaming thread that still uses them would crash the player. An exit handler therefore
/// waits, for one second at most, until no frame is being analysed, and stops further permits.
class AnalysisPermit {
 public:
  AnalysisPermit();
  ~AnalysisPermit();
  AnalysisPermit(const AnalysisPermit&) = delete;
  AnalysisPermit& operator=(const AnalysisPermit&) = delete;

  /// Returns false when the process is exiting: the frame must then pass unchanged.
  explicit operator bool() const { return is_given_; }

 private:
  bool is_given_;
};

}  // namespace spidar::filter
