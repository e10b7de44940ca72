#include "core/tracking/tracker.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace spidar {

void validate(const TrackerSettings& settings) {
  constexpr int kMostFeatures = 10000;
  if (settings.max_features < 1 || settings.max_features > kMostFeatures) {
    throw std::invalid_argument("max_features must be 1 to " + std::to_string(kMostFeatures) +
                                ", got " + std::to_string(settings.max_features));
  }
  if (!(settings.quality_level >= 0 && settings.quality_level <= 1)) {
    throw std::invalid_argument("quality_level must be 0 to 1, got " +
                                std::to_string(settings.quality_level));
  }
  if (!std::isfinite(settings.min_distance_px) || settings.min_distance_px < 0) {
    throw std::invalid_argument("min_distance_px must be finite and not negative, got " +
                                std::to_string(settings.min_distance_px));
  }
}

void require_usable(const ImageView& frame) {
  if (frame.data && frame.width >= kMinSide_px && frame.height >= kMinSide_px &&
      frame.stride_bytes >= frame.width) {
    return;
  }
  throw std::invalid_argument(
      "a frame needs data, at least " + std::to_string(kMinSide_px) + "x" +
      std::to_string(kMinSide_px) + " pixels and a stride of at least its width; got " +
      (frame.data ? "" : "no data, ") + std::to_string(frame.width) + "x" +
      std::to_string(frame.height) + " with stride " + std::to_string(frame.stride_bytes));
}

}  // namespace spidar
