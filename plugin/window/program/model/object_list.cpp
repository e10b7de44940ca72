// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/program/model/object_list.h"

#include <algorithm>

#include "plugin/window/program/model/object_click.h"

namespace spidar {
namespace {

/// Of a picture: what it shows is by this much wider and higher than the object.
constexpr double kMargin = 1.3;
constexpr double kPictureAspect = 4.0 / 3;

/// Of the object's box, inside of the visible part of the frame, in px of that.
Rect visible_box(const FrameFacts& facts, const MovingObject& object,
                 const Eigen::Vector2d& size_px) {
  const Eigen::Vector2d frame_px(facts.visible.width, facts.visible.height);
  const Eigen::Vector2d middle_px = object.position_px + frame_px / 2;
  const Eigen::Vector2d none(0, 0);
  const Eigen::Vector2d low = (middle_px - size_px / 2).cwiseMax(none).cwiseMin(frame_px);
  const Eigen::Vector2d high = (middle_px + size_px / 2).cwiseMax(none).cwiseMin(frame_px);
  return {low.x(), low.y(), high.x() - low.x(), high.y() - low.y()};
}

/// What a picture of the object shows.
Rect pictured_box(const FrameFacts& facts, const MovingObject& object) {
  const double width = kMargin * std::max(object.size_px.x(), object.size_px.y() * kPictureAspect);
  return visible_box(facts, object, {width, width / kPictureAspect});
}

}  // namespace

std::string short_name(uint32_t id) {
  return "#" + std::to_string(id);
}

Eigen::Vector2d place_of(const FrameFacts& facts, const MovingObject& object) {
  const Rect box = visible_box(facts, object, object.size_px);
  const auto place_at = [&](double across, double down) {
    return Eigen::Vector2d((box.x + across * box.width) / std::max(facts.visible.width, 1),
                           (box.y + down * box.height) / std::max(facts.visible.height, 1));
  };
  constexpr std::array<double, 5> kShares{0.5, 0.3, 0.7, 0.1, 0.9};  // the middle first
  for (const double down : kShares) {
    for (const double across : kShares) {
      const MovingObject* const there = object_at(facts, place_at(across, down));
      if (there && there->id == object.id) return place_at(across, down);
    }
  }
  return place_at(0.5, 0.5);
}

/// Null when there is no place for it.
ListedObject* ObjectList::enter(const FrameFacts& facts, const MovingObject& object) {
  ListedObject entry;
  if (objects_.size() < kMost) {
    std::array<bool, kMost> taken{};
    for (const ListedObject& other : objects_) taken[other.slot] = true;
    entry.slot = static_cast<size_t>(std::find(taken.begin(), taken.end(), false) - taken.begin());
  } else {
    const auto gone = std::find_if(objects_.begin(), objects_.end(),
                                   [](const ListedObject& other) { return !other.is_in_sight; });
    if (gone == objects_.end()) return nullptr;
    entry.slot = gone->slot;
    objects_.erase(gone);
  }
  entry.id = object.id;
  entry.first_ns = facts.film.stream_ns;
  entry.first_place = facts.scene.turn.place_shown(place_of(facts, object));
  entry.first_s = now_s_;
  objects_.push_back(entry);
  return &objects_.back();
}

void ObjectList::see(const FrameFacts& facts) {
  const FilmMoment& film = facts.film;
  const double time_s = 1e-9 * static_cast<double>(facts.running_ns);
  if (!film.is_same_scene(film_) || time_s < now_s_) objects_.clear();
  film_ = film;
  now_s_ = time_s;
  for (ListedObject& entry : objects_) entry.is_in_sight = entry.is_felt = false;
  const std::vector<uint32_t> felt = felt_objects(facts);
  for (const MovingObject& object : facts.scene.objects) {
    if (object.tracks == 0) continue;
    const auto known = std::find_if(objects_.begin(), objects_.end(),
                                    [&](const ListedObject& one) { return one.id == object.id; });
    ListedObject* const entry = known != objects_.end() ? &*known : enter(facts, object);
    if (!entry) continue;
    const Rect box = visible_box(facts, object, object.size_px);
    entry->place = place_of(facts, object);
    entry->box = pictured_box(facts, object);
    entry->area_px2 = box.width * box.height;
    entry->seen_s = now_s_;
    entry->is_in_sight = true;
    entry->is_felt = std::find(felt.begin(), felt.end(), object.id) != felt.end();
  }
  const auto is_gone = [&](const ListedObject& entry) { return entry.seen_s + kGone_s < now_s_; };
  objects_.erase(std::remove_if(objects_.begin(), objects_.end(), is_gone), objects_.end());
}

std::vector<const ListedObject*> ObjectList::rows() const {
  std::vector<const ListedObject*> rows;
  for (const ListedObject& entry : objects_) {
    if (entry.is_felt || entry.seen_s - entry.first_s >= kLeast_s) rows.push_back(&entry);
  }
  return rows;
}

const ListedObject* ObjectList::find(uint32_t id) const {
  const auto found = std::find_if(objects_.begin(), objects_.end(),
                                  [&](const ListedObject& entry) { return entry.id == id; });
  return found == objects_.end() ? nullptr : &*found;
}

std::vector<const ListedObject*> ObjectList::without_picture() const {
  std::vector<const ListedObject*> wanted;
  for (const ListedObject& entry : objects_) {
    const bool is_better = entry.area_px2 > kBetter * entry.pictured_px2;
    if (entry.is_in_sight && is_better && entry.box.width >= 1 && entry.box.height >= 1) {
      wanted.push_back(&entry);
    }
  }
  return wanted;
}

void ObjectList::pictured(uint32_t id) {
  for (ListedObject& entry : objects_) {
    if (entry.id == id) entry.pictured_px2 = entry.area_px2;
  }
}

}  // namespace spidar
