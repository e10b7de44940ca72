// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/program/model/sightings.h"

#include <algorithm>

#include "plugin/window/program/model/object_click.h"

namespace spidar {

void Sightings::see(const FrameFacts& facts) {
  const int64_t now_ns = facts.film.stream_ns;
  if (!facts.film.is_same_scene(film_) || now_ns < film_.stream_ns) seen_.clear();
  film_ = facts.film;
  for (const MovingObject& object : facts.scene.objects) {
    if (object.tracks == 0) continue;
    auto known = std::find_if(seen_.begin(), seen_.end(),
                              [&](const Sighting& one) { return one.id == object.id; });
    if (known == seen_.end()) {
      const Eigen::Vector2d place = facts.scene.turn.place_shown(place_of(facts, object));
      known = seen_.insert(known, {object.id, now_ns, place, now_ns});
    }
    known->last_ns = now_ns;
  }
  const auto is_gone = [&](const Sighting& one) { return one.last_ns + kForgotten_ns < now_ns; };
  seen_.erase(std::remove_if(seen_.begin(), seen_.end(), is_gone), seen_.end());
}

const Sighting* Sightings::find(uint32_t id) const {
  const auto found =
      std::find_if(seen_.begin(), seen_.end(), [&](const Sighting& one) { return one.id == id; });
  return found == seen_.end() ? nullptr : &*found;
}

}  // namespace spidar
