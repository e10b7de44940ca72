// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What the desktop's portal answers. It is another program, so each value is checked for its type.
#pragma once

#include <cstdint>
#include <gio/gio.h>
#include <string>

#include "plugin/gobject/ref.h"

namespace spidar::screen {

/// Reads a value as g_variant_get() does. Returns false, and reads nothing, if it is of another
/// type.
template <typename... To>
bool read_variant(GVariant* value, const char* format, To... to) {
  if (!value || !g_variant_check_format_string(value, format, FALSE)) return false;
  g_variant_get(value, format, to...);
  return true;
}

/// Of a Request, the status and an "a{sv}" of results; none if it is no such answer.
struct PortalAnswer {
  static constexpr guint kAllowed = 0, kCancelled = 1;

  explicit PortalAnswer(GVariant* parameters = nullptr) {
    GVariant* all = nullptr;
    if (read_variant(parameters, "(u@a{sv})", &status, &all)) results.reset(all);
  }

  guint status = ~0U;
  Ref<GVariant> results;
};

/// Of the results of CreateSession, the object that is the session; empty if they name none.
inline std::string session_in(GVariant* results) {
  const gchar* path = "";
  g_variant_lookup(results, "session_handle", "&s", &path);
  return g_variant_is_object_path(path) ? path : "";
}

/// Of the results of Start.
struct Shared {
  // Of the interface: AvailableSourceTypes and `types`.
  static constexpr guint kMonitor = 1, kWindow = 2;

  Shared() = default;
  explicit Shared(GVariant* results) {
    const gchar* text = "";
    g_variant_lookup(results, "restore_token", "&s", &text);
    token = text;
    const Ref<GVariant> streams(
        g_variant_lookup_value(results, "streams", G_VARIANT_TYPE("a(ua{sv})")));
    if (!streams || g_variant_n_children(streams.get()) == 0) return;
    GVariant* about = nullptr;
    g_variant_get_child(streams.get(), 0, "(u@a{sv})", &node, &about);
    const Ref<GVariant> own(about);
    guint kind = kMonitor;
    g_variant_lookup(about, "source_type", "u", &kind);
    is_window = kind == kWindow;
    is_something = true;
  }

  bool is_something = false;  ///< otherwise the desktop shares nothing
  bool is_window = false;
  uint32_t node = 0;
  std::string token;  ///< for the next time; empty if the desktop gives none
};

}  // namespace spidar::screen
