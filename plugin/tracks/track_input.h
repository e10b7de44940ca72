// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <gst/audio/audio.h>

#include "core/fields.h"
#include "core/track/track_format.h"
#include "core/track/track_reader.h"
#include "plugin/tracks/track_summary.h"

namespace spidar::tracks {

struct Faults {
  uint64_t not_finite = 0;   ///< samples with a channel that is not finite: zero instead
  uint64_t beyond_full = 0;  ///< samples with a channel beyond the full scale
  int sound_channel = -1;    ///< a channel that is audible sound, see Band; -1: none
};

/// Fields for `stats`, with the number of `samples` and of those that were `refused`.
inline void sample_fields(uint64_t samples, const Faults& faults, uint64_t refused, FieldSink& to) {
  to("samples", "", samples, "samples of the track that were received");
  to("samples-not-finite", "", faults.not_finite,
     "samples that are not numbers; they count as rest");
  to("samples-beyond-full-scale", "", faults.beyond_full,
     "samples that were limited to full scale");
  to("samples-refused", "", refused,
     "samples that were not rendered, because too many were waiting");
}

/// Converts buffers of sound to blocks of a haptic track. Follows everything that their caps state:
/// format with its byte order, rate, channels and their mask, and the layout, interleaved or not.
/// Streaming thread only.
class Input {
 public:
  static constexpr int kLowestRate_Hz = 200;
  static constexpr int kHighestRate_Hz = 8000;

  /// Returns an empty string, or a sentence that says why sound of these caps is not a haptic
  /// track, and what would be.
  std::string set_caps(const GstCaps* caps);
  /// Call this when the next buffer does not continue the previous one.
  void reset();

  /// Passes the samples of `buffer` in `segment`, times `gain`, to `give`, in blocks of rising
  /// running time, until `give` returns something other than GST_FLOW_OK. In reverse playback, the
  /// last sample comes first. A buffer without a timestamp follows the previous one.
  GstFlowReturn read(GstBuffer* buffer, const GstSegment& segment, double gain,
                     const std::function<GstFlowReturn(const TrackBlock&)>& give);

  /// Running time of the end of the last buffer; GST_CLOCK_TIME_NONE before the first.
  GstClockTime end() const { return end_; }
  const Faults& faults() const { return faults_; }
  uint64_t samples() const { return samples_; }

 private:
  size_t samples_in(GstBuffer* buffer) const;
  bool unpack(GstBuffer* buffer);
  void unpack(const guint8* from, size_t values, double* to);
  TrackSample sample(size_t i, double gain);

  GstAudioInfo info_{};
  TrackThinner thinner_;
  GstClockTime next_pts_ = GST_CLOCK_TIME_NONE;
  GstClockTime end_ = GST_CLOCK_TIME_NONE;
  std::vector<gdouble> doubles_;  ///< of a buffer, sample by sample
  std::vector<gdouble> plane_;    ///< of a channel
  std::vector<gint32> integers_;  ///< as the format unpacks
  Band band_;
  Faults faults_;
  uint64_t samples_ = 0;
};

}  // namespace spidar::tracks
