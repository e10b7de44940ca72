// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The desktop's portal for what is on the screen, org.freedesktop.portal.ScreenCast.
#pragma once

#include <cstdint>
#include <gio/gio.h>
#include <string>
#include <vector>

#include "plugin/gobject/ref.h"

namespace spidar::screen {

/// One sharing of a screen or a window, which the user allows in a dialog of the desktop.
/// Everything throws std::runtime_error, which says what is wrong and what helps. Iterates the main
/// context while it waits. One thread.
class ScreenCast {
 public:
  /// `token` is that of a sharing that was allowed before; the desktop then asks only if it is
  /// void. Empty: it asks.
  explicit ScreenCast(const std::string& token);
  /// Ends the sharing.
  ~ScreenCast();
  ScreenCast(const ScreenCast&) = delete;
  ScreenCast& operator=(const ScreenCast&) = delete;

  /// For a PipeWire client; stays owned by this.
  int descriptor() const { return descriptor_; }
  uint32_t node() const { return node_; }
  bool is_window() const { return is_window_; }
  /// For the next time; empty if the desktop gives none.
  const std::string& token() const { return token_; }
  /// Whether the desktop or the user has ended it.
  bool has_ended() const { return has_ended_; }

 private:
  void check_portal();
  /// Calls a method that answers by a Request, and returns its results. `arguments` are floating,
  /// and `options` follow them.
  Ref<GVariant> ask(const char* method, std::vector<GVariant*> arguments, GVariantBuilder& options);
  Ref<GVariant> call(const char* interface, const char* method, GVariant* arguments,
                     GUnixFDList** descriptors = nullptr) const;
  void open_remote();

  Ref<GDBusConnection> bus_;
  std::string session_;
  std::string token_;
  guint ended_signal_ = 0;
  int descriptor_ = -1;
  uint32_t node_ = 0;
  bool is_window_ = false;
  bool has_ended_ = false;
};

}  // namespace spidar::screen
