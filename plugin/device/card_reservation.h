// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Asks a sound server for a card.
#pragma once

#include <gio/gio.h>
#include <memory>
#include <string>

#include "plugin/gobject/ref.h"

namespace spidar {

/// A card that PulseAudio, or the session manager of PipeWire, leaves to this process as long as
/// this object lives: org.freedesktop.ReserveDevice1 on the session bus, which both of them follow.
/// Needs no main loop.
class CardReservation {
 public:
  /// The time that the bus and the owner of the card have in all to give it away.
  static constexpr int kPatience_ms = 3000;

  /// `card` is ALSA's number. Null, and why in `refused`, if the card was not given away; null
  /// without a reason where there is no session bus, and so nobody to ask.
  static std::unique_ptr<CardReservation> take(int card, std::string& refused);
  ~CardReservation();
  CardReservation(const CardReservation&) = delete;
  CardReservation& operator=(const CardReservation&) = delete;

 private:
  explicit CardReservation(int card);

  /// The time left until until_us_; at least 1 ms.
  int left_ms() const;
  bool request_name(guint32 flags, std::string& refused) const;
  bool is_given_away(std::string& refused) const;
  Ref<GVariant> call(const char* to, const char* path, const char* interface, const char* method,
                     GVariant* arguments, const char* result_type, std::string& refused) const;
  static GDBusMessage* answer(GDBusConnection* bus, GDBusMessage* message, gboolean incoming,
                              gpointer path);

  const std::string name_, path_;
  gint64 until_us_;  ///< g_get_monotonic_time(), when waiting ends
  Ref<GDBusConnection> bus_;
};

}  // namespace spidar
