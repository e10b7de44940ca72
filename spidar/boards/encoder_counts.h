/// Counts of a board over the times that it is opened.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "spidar/protocols/count_unwrapper.h"

namespace spidar {

class EncoderCounts {
 public:
  using Raw = std::array<uint32_t, kMaxStrings>;

  explicit EncoderCounts(int bits) noexcept : unwrapper_(bits) {}

  /// First reading after opening.
  void open(const Raw& raw, size_t channels) noexcept {
    first_ = raw;
    channels_ = channels;
    if (!counted_) unwrapper_.begin(raw, channels);
    counted_ = true;
    restarted_ = !unwrapper_.resume(raw, channels);
  }

  /// The counters began anew since the board was open before: what they say means nothing, until
  /// zero().
  bool restarted() const noexcept { return restarted_; }

  /// Zero is where the first reading was.
  void zero() noexcept {
    unwrapper_.begin(first_, channels_);
    unwrapper_.zero();
    restarted_ = false;
  }

  /// As the board counts, from this reading on.
  void begin(const Raw& raw) noexcept {
    unwrapper_.begin(raw, channels_);
    restarted_ = false;
  }

  /// False, and nothing taken over, when a counter jumped.
  bool follow(const Raw& raw) noexcept { return unwrapper_.follow(raw, channels_); }

  const std::array<int32_t, kMaxStrings>& counts() const noexcept { return unwrapper_.counts(); }

 private:
  CountUnwrapper unwrapper_;
  Raw first_{};
  size_t channels_ = 0;
  bool counted_ = false;
  bool restarted_ = false;
};

}  // namespace spidar
