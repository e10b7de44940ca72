// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/api/surface.h"

#include <chrono>
#include <iomanip>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "core/points/tracker.h"
#include "spidar/api/vectors.h"
#include "spidar/loop/stiffness_limit.h"
#include "spidar/realtime/monotonic.h"

namespace gst_spidar {
inline namespace v0 {
namespace {

constexpr double kMaxRelief_m = 0.03;

[[noreturn]] void refuse(const char* what, double most, const char* unit, double got) {
  std::ostringstream text;
  text << std::setprecision(4) << what << " must be at most " << most << ' ' << unit << ", got "
       << got;
  throw std::invalid_argument(text.str());
}

spidar::touch::ContactSettings contact_of(const Surface& surface, const SurfaceRange& range) {
  if (surface.stiffness_N_m > range.most_stiffness_N_m) {
    refuse("the stiffness of a surface", range.most_stiffness_N_m, "N/m on this device",
           surface.stiffness_N_m);
  }
  spidar::touch::ContactSettings contact;
  contact.stiffness_N_m = surface.stiffness_N_m;
  contact.delay_s = spidar::surface_delay_s(range.drive_lag_s);
  contact.friction = surface.friction;
  contact.texture = surface.texture;
  spidar::touch::validate(contact);
  return contact;
}

spidar::touch::ReliefSettings relief_of(const Surface& surface) {
  spidar::touch::ReliefSettings relief;
  relief.relief_m = surface.relief_m;
  relief.floor_z_m = -0.5 * surface.relief_m;
  spidar::touch::validate(relief);
  if (surface.relief_m > kMaxRelief_m) {
    refuse("the height of a relief", kMaxRelief_m, "m", surface.relief_m);
  }
  return relief;
}

}  // namespace

bool TouchedSurface::set(const Surface& surface, const SurfaceRange& range,
                         spidar::HapticLoop& loop) {
  if (!(range.half_size_m.minCoeff() > 0)) {
    throw std::invalid_argument(
        "this device has no surfaces: it takes no force towards the viewer; a SPIDAR with six "
        "strings or more does");
  }
  const spidar::touch::ContactSettings contact = contact_of(surface, range);
  const spidar::touch::ReliefSettings relief = relief_of(surface);
  const spidar::ImageView picture = from_api(surface.picture);
  spidar::require_usable(picture);
  if (!mailbox_) {
    mailbox_ = std::make_unique<spidar::touch::Mailbox>(
        2 * range.half_size_m.x(), 2 * range.half_size_m.y(), spidar::touch::Mailbox::kMinSlots);
    loop.connect_touch(mailbox_.get());
    connected_ = mailbox_.get();
  }
  if (loop.snapshot().last.device == spidar::DeviceState::kLost) return false;
  spidar::touch::Surface* const frame = free_slot();
  if (frame == nullptr) return false;
  builder_.from_brightness(picture, relief, frame->relief);
  frame->has_texture = surface.texture > 0;
  if (frame->has_texture) builder_.fine_detail(relief, frame->texture);
  frame->contact = contact;
  frame->has_surface = true;
  frame->follows = false;
  frame->time_ns = spidar::monotonic_now_ns();
  mailbox_->publish();
  return true;
}

void TouchedSurface::clear() noexcept {
  if (spidar::touch::Mailbox* const mailbox = connected_) mailbox->clear();
}

/// The loop frees the slots of former surfaces in its next tick, unless the device is lost.
spidar::touch::Surface* TouchedSurface::free_slot() noexcept {
  constexpr int kTicks = 20;
  for (int i = 0; i < kTicks; ++i) {
    if (spidar::touch::Surface* const frame = mailbox_->begin(mailbox_->generation())) return frame;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return nullptr;
}

}  // namespace v0
}  // namespace gst_spidar
