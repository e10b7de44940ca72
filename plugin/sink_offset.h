/// A sink that shows frames at other times than their own.
#pragma once

#include <gst/gst.h>

namespace spidar {

/// `ts-offset` of the sink that an element's frames end in: players set it when the sound is late
/// (playbin: av-offset). No event or query tells of it.
///
/// Not thread-safe: the owner holds one lock around it.
class SinkOffset {
 public:
  SinkOffset() = default;
  ~SinkOffset() { forget(); }
  SinkOffset(const SinkOffset&) = delete;
  SinkOffset& operator=(const SinkOffset&) = delete;

  /// Looks downstream of `element`, through bins, for the first sink that waits for the clock, and
  /// keeps it until told to forget it. Again whenever it may be another one.
  void follow(GstElement* element);
  void forget();

  /// As it is now; > 0: shown later. 0 without such a sink.
  GstClockTimeDiff value_ns() const;

 private:
  GstElement* sink_ = nullptr;
};

}  // namespace spidar
