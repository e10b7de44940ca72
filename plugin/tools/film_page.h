// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/track/track_format.h"

namespace spidar::tools {

/// The box of the felt object in one frame.
struct FeltBox {
  int64_t stream_ns = 0;
  /// Left, top, right and bottom, as fractions of the shown picture; all 0 if unknown.
  std::array<double, 4> edges{};

  bool is_known() const { return edges[2] > edges[0]; }
};

/// Finds the box in each frame as spidarmotion measures it with `settings`, see RecordProperties.
/// Throws std::runtime_error, without the name of the film, when the film cannot be played to its
/// end, or the settings are not those of a track. `report` is that of FilmProgress.
std::vector<FeltBox> find_felt_boxes(const std::string& film, const std::string& settings,
                                     const std::function<void(int percent)>& report);

std::string base64(const std::string& bytes);

class FilmPage {
 public:
  /// The curves become coarser until the page is smaller than this, which mail and chat accept.
  static constexpr size_t kMax_bytes = 100'000;

  struct Html {
    std::string text;
    double tolerance_N = 0;  ///< largest error of the shown force along an axis
  };

  /// Adds the next millisecond of the track. Values that are not finite count as 0.
  void add(const TrackSample& sample);

  /// Sets where the felt object is; `boxes` are in the order of time, which is that of the track.
  /// Without them, the arrow begins in the middle of the picture.
  void set_boxes(const std::vector<FeltBox>& boxes);

  /// Returns a page for browsers that plays a film with its force. `url` is the address of the
  /// film, relative to the page, `name` its name for people, `type` its MIME type. The film shows
  /// its pictures `later_s` seconds later than the track says. `unplayed` is why_no_browser().
  Html html(const std::string& url, const std::string& name, const std::string& type,
            double later_s, const std::string& unplayed) const;

 private:
  /// Boxes are shown at the rate of a screen.
  static constexpr size_t kBoxStep_samples = 10;
  static constexpr size_t kAxes = 3;

  std::array<std::vector<float>, kAxes> force_N_;
  double largest_N_ = 0;
  std::array<std::vector<float>, 4> edges_;  ///< of FeltBox, from -1 to 1, of each step; or empty
};

}  // namespace spidar::tools
