// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <gio/gio.h>
#include <memory>
#include <string>

#include "plugin/gobject/ref.h"

namespace spidar {

/// Reserves a sound card: PulseAudio, or the session manager of PipeWire, leaves the card to this
/// process while this object exists. Both implement org.freedesktop.ReserveDevice1 on the session
/// bus. No main loop is needed.
class CardReservation {
 public:
  /// The time limit for the whole reservation, in which the bus and the owner must answer.
  static constexpr int kAnswerTimeout_ms = 3000;

  /// `card` is its ALSA number. Returns null, with the reason in `refused`, if the owner does not
  /// release the card; null without a reason if there is no session bus, and hence no owner.
  static std::unique_ptr<CardReservation> reserve(int card, std::string& refused);
  ~CardReservation();
  CardReservation(const CardReservation&) = delete;
  CardReservation& operator=(const CardReservation&) = delete;

 private:
  explicit CardReservation(int card);

  int left_ms() const;
  bool request_name(guint32 flags, std::string& refused) const;
  bool request_release(std::string& refused) const;
  Ref<GVariant> call(const char* to, const char* path, const char* interface, const char* method,
                     GVariant* arguments, const char* result_type, std::string& refused) const;
  static GDBusMessage* answer(GDBusConnection* bus, GDBusMessage* message, gboolean incoming,
                              gpointer path);

  const std::string name_, path_;
  gint64 until_us_;  ///< g_get_monotonic_time(), when waiting ends
  Ref<GDBusConnection> bus_;
};

}  // namespace spidar
