// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/feel/follow/film_thread.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "plugin/feel/follow/felt_element.h"
#include "spidar/realtime/monotonic.h"

namespace spidar::follow {
namespace {

/// As often as the loop receives the playback clock.
constexpr std::chrono::milliseconds kTick{10};
/// An older goal means that the main loop stands still, or the machine is very busy.
constexpr int64_t kStale_ns = 300'000'000;

/// Returns false when the film has failed.
bool go_to(FollowedFilm& film, const FilmGoal& goal) {
  if (!film.check()) return false;
  const int64_t now_ns = monotonic_now_ns();
  const int64_t passed_ns = now_ns - goal.at_ns;
  if (goal.plays && goal.position_ns && passed_ns < kStale_ns) {
    const int64_t since_ns = std::llround(static_cast<double>(passed_ns) * goal.rate);
    film.follow(now_ns, *goal.position_ns + since_ns, goal.rate);
  } else {
    film.rest(goal.plays ? std::nullopt : goal.position_ns);
  }
  return true;
}

}  // namespace

FilmThread::FilmThread(std::vector<std::string> properties)
    : properties_(std::move(properties)), thread_([this] { run(); }) {}

FilmThread::~FilmThread() {
  thread_.join();
}

void FilmThread::aim(FilmGoal goal) {
  const std::lock_guard<std::mutex> lock(mutex_);
  goal_ = std::move(goal);
}

FilmWish FilmThread::take_wish() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(wish_, {});
}

bool FilmThread::end(std::chrono::milliseconds limit) {
  std::unique_lock<std::mutex> lock(mutex_);
  ends_ = true;
  changed_.notify_all();
  return changed_.wait_for(lock, limit, [this] { return has_ended_; });
}

void FilmThread::run() {
  std::shared_ptr<const FilmPlan> plan;
  std::unique_ptr<FollowedFilm> film;
  std::unique_lock<std::mutex> lock(mutex_);
  while (!changed_.wait_for(lock, kTick, [this] { return ends_; })) {
    const FilmGoal goal = goal_;
    lock.unlock();
    if (goal.plan != plan) {
      plan = goal.plan;
      film.reset();  // which releases the device for the next film
      try {
        if (plan) film = std::make_unique<FollowedFilm>(*plan, properties_);
      } catch (const std::runtime_error& error) {
        tell(plan->name + ": " + error.what());
      }
    }
    if (film && !go_to(*film, goal)) {
      tell("without force until the next film: " + plan->name);
      film.reset();
    }
    const FilmWish wish = film ? film->take_wish() : FilmWish();
    lock.lock();
    wish_.add(wish);
  }
  lock.unlock();
  film.reset();
  lock.lock();
  has_ended_ = true;
  changed_.notify_all();
}

}  // namespace spidar::follow
