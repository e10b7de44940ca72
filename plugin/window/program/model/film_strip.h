// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A whole film as a line, with marks where a rule says what is felt.
#pragma once

#include <cstdint>
#include <vector>

#include "core/choice/feel_edit.h"
#include "core/choice/feel_rules.h"
#include "plugin/window/program/model/window_model.h"

namespace spidar {

struct StripMark {
  FeelRule rule;
  bool is_new = false;  ///< not saved yet
};

struct FilmStrip {
  int64_t now_ns = 0;
  int64_t length_ns = 0;  ///< 0: there is nothing to show
  std::vector<StripMark> marks;

  /// 0 at the begin of the film, 1 at its end; never beyond.
  double share(int64_t ns) const;
  /// The mark at this share, or no further than `reach` from it; null when there is none.
  const StripMark* at(double place, double reach) const;
};

/// Of a film from a file of which the time is known. `rules` may be null.
FilmStrip film_strip(const FilmMoment& film, const FeelRules* rules,
                     const std::vector<FeelEdit>& edits);

}  // namespace spidar
