// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <gio/gio.h>
#include <string>

#include "plugin/gobject/ref.h"

namespace spidar::screen {

/// Reads a value of the desktop's portal as g_variant_get() does. The portal is another program, so
/// this checks the type of the value: returns false, and reads nothing, if the type is wrong.
template <typename... To>
bool read_variant(GVariant* value, const char* format, To... to) {
  if (!value || !g_variant_check_format_string(value, format, FALSE)) return false;
  g_variant_get(value, format, to...);
  return true;
}

/// The answer to a Request: its status and its results, an "a{sv}"; null if it has another form.
struct PortalAnswer {
  static constexpr guint kAllowed = 0, kCancelled = 1;

  explicit PortalAnswer(GVariant* parameters = nullptr) {
    GVariant* all = nullptr;
    if (read_variant(parameters, "(u@a{sv})", &status, &all)) results.reset(all);
  }

  guint status = ~0U;
  Ref<GVariant> results;
};

/// The object path of the session in the results of CreateSession; empty if there is none.
inline std::string session_in(GVariant* results) {
  const gchar* path = "";
  g_variant_lookup(results, "session_handle", "&s", &path);
  return g_variant_is_object_path(path) ? path : "";
}

/// The results of Start.
struct Shared {
  // Values of AvailableSourceTypes and `types` in the interface.
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

  bool is_something = false;  ///< false: the desktop shares nothing
  bool is_window = false;
  uint32_t node = 0;
  std::string token;  ///< for the next time; empty if the desktop gives none
};

}  // namespace spidar::screen
