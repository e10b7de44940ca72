// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The analysis of the frames that pass.
#pragma once

#include <cstdint>
#include <optional>

#include "core/analysis/motion_analyzer.h"
#include "core/analysis/square_pixel_resampler.h"
#include "plugin/filter/engine/frame_touch.h"
#include "plugin/filter/engine/wrench_source.h"
#include "plugin/filter/reports/no_force_watch.h"
#include "plugin/frame/frame_luma.h"
#include "plugin/timing/frame_pacer.h"
#include "plugin/timing/wrench_backlog.h"

namespace spidar {

class LiveSource : public WrenchSource {
 public:
  /// All are the engine's, and outlive this. `schedule` takes the wrenches; `turn` is how frames
  /// are turned before they are shown.
  LiveSource(WrenchBacklog& schedule, NoForceWatch& limits, FrameTouch& touch,
             const Orientation& turn)
      : schedule_(schedule), limits_(limits), touch_(touch), turn_(turn) {}

  void configure(const AnalyzerSettings& settings) { analyzer_.configure(settings); }

  /// The next frame has nothing to do with the one before.
  void restart() { analyzer_.restart(); }
  bool take(const PassingFrame& frame, int64_t running_ns, FrameReport& report) override;
  void pass_gap(GstBuffer* buffer, const GstSegment& segment, int64_t running_ns) override;

  void begin_segment() { pacer_.begin_segment(); }
  /// Running time begins anew.
  void restart_timing();
  /// There are no frames from this running time on, but for those that the decoder holds: the gap
  /// event of a demuxer overtakes them, and begins too early when the last one is not the newest.
  void begin_gap(GstClockTime running_time);
  /// Nothing more comes.
  void end_of_stream();

 private:
  bool follows(const PassingFrame& frame, int64_t running_ns, FrameReport& report);
  bool analyze(const PassingFrame& frame, const ImageView& luma, int64_t paced_ns,
               FrameReport& report);
  void end_gap(int64_t running_ns);
  void run_out(GstClockTime running_time);

  WrenchBacklog& schedule_;
  NoForceWatch& limits_;
  FrameTouch& touch_;
  const Orientation& turn_;
  FrameLuma luma_;
  SquarePixelResampler square_;
  MotionAnalyzer analyzer_;
  FramePacer pacer_;
  std::optional<int64_t> gap_ns_;  // where a gap begins, unless a frame comes there
  double motion_fraction_ = 1;     // of the newest frame's wrench
};

}  // namespace spidar
