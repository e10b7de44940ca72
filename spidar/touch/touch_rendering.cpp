// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/touch/touch_rendering.h"

#include <stdexcept>
#include <string>

namespace spidar::touch {

Mailbox::Mailbox(double width_m, double height_m, size_t slots) {
  if (slots < kMinSlots) {
    throw std::invalid_argument("touch::Mailbox: slots must be at least " +
                                std::to_string(kMinSlots) + ", but is " + std::to_string(slots));
  }
  frames_.reserve(slots);
  for (size_t i = 0; i < slots; ++i) frames_.emplace_back(width_m, height_m);
}

Surface* Mailbox::begin(uint32_t generation) noexcept {
  const size_t tail = tail_.load(std::memory_order_relaxed);
  if (tail - head_.load(std::memory_order_acquire) == frames_.size()) return nullptr;
  Surface& frame = frames_[tail % frames_.size()];
  frame.generation = generation;
  return &frame;
}

void Mailbox::publish() noexcept {
  tail_.store(tail_.load(std::memory_order_relaxed) + 1, kRelease);
}

const Surface* Mailbox::front(size_t nth) const noexcept {
  const size_t head = head_.load(std::memory_order_relaxed);
  if (tail_.load(std::memory_order_acquire) - head <= nth) return nullptr;
  return &frames_[(head + nth) % frames_.size()];
}

namespace {

bool leads_to(const Surface& before, const Surface& after) noexcept {
  return after.follows && before.has_surface && after.has_surface &&
         after.time_ns > before.time_ns && after.displacement_m.allFinite();
}

/// Compares generation numbers, which wrap around.
bool is_older(uint32_t generation, uint32_t than) noexcept {
  return static_cast<int32_t>(than - generation) > 0;
}

}  // namespace

Contact Rendering::tick(Mailbox& mailbox, int64_t running_ns, const Eigen::Vector3d& grip_m,
                        double dt_s) noexcept {
  drop_cleared(mailbox);
  advance(mailbox, running_ns);
  Contact result;
  const Surface* const now = frame(mailbox, 0);
  if (!reached_ || now == nullptr || !now->has_surface) {
    contact_.reset();
    stiffness_N_m_ = 0;
    return result;
  }
  if (!(dt_s <= kLongestTick_s)) contact_.reset();

  const Surface* const next = leads_on_ ? frame(mailbox, 1) : nullptr;
  MovingRelief surface{&now->relief};
  const Surface* nearest = now;
  if (next != nullptr && leads_to(*now, *next)) {
    surface.after = &next->relief;
    surface.displacement_m = next->displacement_m;
    surface.fraction = fraction_of_next(running_ns);
    jumped_ = jumped_ || jumps(surface, grip_m.head<2>());
    if (jumped_) {
      surface = {&now->relief};
    } else if (surface.fraction >= 0.5) {
      nearest = next;
    }
  }
  ContactSettings settings = nearest->contact;
  if (stiffness_N_m_ <= 0) stiffness_N_m_ = shake_watch_.fraction() * settings.stiffness_N_m;
  const double most_N_m = kStiffening_N_m_s * std::clamp(dt_s, 0.0, kLongestTick_s);
  settings.stiffness_N_m *= shake_watch_.fraction();
  stiffness_N_m_ += std::clamp(settings.stiffness_N_m - stiffness_N_m_, -most_N_m, most_N_m);
  settings.stiffness_N_m = stiffness_N_m_;
  settings.max_force_N = max_force_N_;
  settings.max_slew_N_s = max_slew_N_s_;
  settings.beside_N = beside_N_;

  result.has_surface = true;
  result.force_N = contact_.tick(surface, nearest->has_texture ? &nearest->texture : nullptr,
                                 settings, grip_m, dt_s);
  const Proxy& proxy = contact_.proxy();
  result.touching = proxy.touching();
  result.stiffness_fraction = shake_watch_.fraction();
  if (result.touching) {
    shake_watch_.update(contact_.velocity_m_s(), proxy.normal(), dt_s);
    result.proxy_m = proxy.position_m();
    result.depth_m = std::max(0.0, proxy.normal().dot(proxy.position_m() - grip_m));
  }
  return result;
}

void Rendering::tick_without_contact(Mailbox& mailbox) noexcept {
  drop_cleared(mailbox);
  contact_.reset();
}

void Rendering::drop_cleared(Mailbox& mailbox) noexcept {
  const uint32_t generation = mailbox.generation();
  if (generation != generation_) {
    generation_ = generation;
    reached_ = leads_on_ = false;
    contact_.reset();
  }
  for (const Surface* oldest = mailbox.front();
       oldest != nullptr && is_older(oldest->generation, generation_); oldest = mailbox.front()) {
    mailbox.drop();
  }
}

/// Also returns null if the frame belongs to a generation that began after this tick.
const Surface* Rendering::frame(const Mailbox& mailbox, size_t nth) const noexcept {
  const Surface* const found = mailbox.front(nth);
  return found != nullptr && found->generation == generation_ ? found : nullptr;
}

void Rendering::advance(Mailbox& mailbox, int64_t running_ns) noexcept {
  const Surface* now = frame(mailbox, 0);
  if (now == nullptr) {
    reached_ = leads_on_ = false;
    return;
  }
  bool just_reached = false;
  if (!reached_) {
    if (now->time_ns > running_ns) return;
    reached_ = just_reached = true;
    leads_on_ = false;
    reached_ns_ = now->time_ns;
  }
  for (const Surface* next = frame(mailbox, 1); next != nullptr; next = frame(mailbox, 1)) {
    if (!leads_on_) {
      leads_on_ = true;
      jumped_ = false;
      // If the next frame is already known, the transition to it begins when the last transition
      // ended, so that the surface does not pause until the next tick.
      from_ns_ = just_reached ? reached_ns_ : running_ns;
      const int64_t interval_ns = next->time_ns - now->time_ns;
      to_ns_ = leads_to(*now, *next)
                   ? std::max(next->time_ns, from_ns_ + std::min(kShortest_ns, interval_ns))
                   : next->time_ns;
    }
    const Surface* const after_next = frame(mailbox, 2);
    const bool late = after_next != nullptr && after_next->time_ns <= running_ns;
    if (running_ns < to_ns_ && !late) return;
    mailbox.drop();
    now = next;
    leads_on_ = false;
    just_reached = true;
    reached_ns_ = std::min(to_ns_, running_ns);
  }
}

/// Whether the surface rises faster at this position than kRise_m_s.
bool Rendering::jumps(const MovingRelief& surface,
                      const Eigen::Vector2d& position_m) const noexcept {
  const Eigen::Vector2d before_m = position_m - surface.fraction * surface.displacement_m;
  const Eigen::Vector2d after_m = before_m + surface.displacement_m;
  const double rise_m = surface.after->at(after_m.x(), after_m.y()).z_m -
                        surface.before->at(before_m.x(), before_m.y()).z_m;
  return rise_m > Proxy::kRise_m_s * 1e-9 * static_cast<double>(to_ns_ - from_ns_);
}

double Rendering::fraction_of_next(int64_t running_ns) const noexcept {
  if (to_ns_ <= from_ns_) return 1;
  const double fraction =
      static_cast<double>(running_ns - from_ns_) / static_cast<double>(to_ns_ - from_ns_);
  return std::clamp(fraction, 0.0, 1.0);
}

}  // namespace spidar::touch
