// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/program/model/film_strip.h"

#include <algorithm>

namespace spidar {

double FilmStrip::share(int64_t ns) const {
  if (length_ns <= 0) return 0;
  return std::clamp(static_cast<double>(ns) / static_cast<double>(length_ns), 0.0, 1.0);
}

const StripMark* FilmStrip::at(double place, double reach) const {
  const StripMark* best = nullptr;
  double nearest = reach;
  for (const StripMark& mark : marks) {
    const double before = share(mark.rule.from_ns) - place, behind = place - share(mark.rule.to_ns);
    const double distance = std::max({before, behind, 0.0});
    if (distance > nearest || (best && distance == nearest)) continue;
    best = &mark;
    nearest = distance;
  }
  return best;
}

FilmStrip film_strip(const FilmMoment& film, const FeelRules* rules,
                     const std::vector<FeelEdit>& edits) {
  FilmStrip strip;
  if (film.name().empty() || film.stream_ns < 0) return strip;
  const std::vector<FeelRule> before = rules ? rules->rules() : std::vector<FeelRule>();
  std::vector<FeelRule> now = before;
  for (const FeelEdit& edit : edits) now = edited(now, edit);
  strip.now_ns = film.stream_ns;
  strip.length_ns = std::max(film.length_ns, film.stream_ns);
  for (const FeelRule& rule : now) {
    if (rule.to_ns != FeelRule::kNoEnd) strip.length_ns = std::max(strip.length_ns, rule.to_ns);
    // A choice that is saved grows with its scene.
    const auto is_same = [&](const FeelRule& other) {
      return other.from_ns == rule.from_ns && other.kind == rule.kind && other.place == rule.place;
    };
    strip.marks.push_back({rule, std::none_of(before.begin(), before.end(), is_same)});
  }
  return strip;
}

}  // namespace spidar
