// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/screen/portal.h"

#include <algorithm>
#include <gio/gunixfdlist.h>
#include <stdexcept>
#include <unistd.h>

namespace spidar::screen {
namespace {

constexpr const char* kPortal = "org.freedesktop.portal.Desktop";
constexpr const char* kPath = "/org/freedesktop/portal/desktop";
constexpr const char* kScreenCast = "org.freedesktop.portal.ScreenCast";
constexpr const char* kRequest = "org.freedesktop.portal.Request";
constexpr const char* kSession = "org.freedesktop.portal.Session";
// Of the interface: AvailableSourceTypes and `types`, `persist_mode`, and the answers of a Request.
constexpr guint kMonitor = 1, kWindow = 2;
constexpr guint kUntilRevoked = 2;
constexpr guint kAllowed = 0, kCancelled = 1;
/// For its first answer, the bus starts the portal, which starts that of the desktop.
constexpr int kStart_ms = 25'000;

[[noreturn]] void refuse(const std::string& what) {
  throw std::runtime_error(what);
}

std::string text_of(GError* error) {
  const std::string text = error ? error->message : "it does not answer";
  g_clear_error(&error);
  return text;
}

struct Answer {
  bool is_there = false;
  guint status = 0;
  Ref<GVariant> results;
};

void take_answer(GDBusConnection*, const gchar*, const gchar*, const gchar*, const gchar*,
                 GVariant* parameters, gpointer user) {
  auto& answer = *static_cast<Answer*>(user);
  if (!g_variant_is_of_type(parameters, G_VARIANT_TYPE("(ua{sv})"))) return;
  GVariant* results = nullptr;
  g_variant_get(parameters, "(u@a{sv})", &answer.status, &results);
  answer.results.reset(results);
  answer.is_there = true;
}

/// A portal that is gone answers nothing more.
void take_owner(GDBusConnection*, const gchar*, const gchar*, const gchar*, const gchar*, GVariant*,
                gpointer user) {
  auto& answer = *static_cast<Answer*>(user);
  answer.is_there = true;
  answer.status = ~0U;
}

void set_true(GDBusConnection*, const gchar*, const gchar*, const gchar*, const gchar*, GVariant*,
              gpointer flag) {
  *static_cast<bool*>(flag) = true;
}

}  // namespace

ScreenCast::ScreenCast(const std::string& token) {
  GError* error = nullptr;
  bus_.reset(g_bus_get_sync(G_BUS_TYPE_SESSION, nullptr, &error));
  if (!bus_) {
    refuse(
        "there is no session bus, on which the desktop is asked for its screen: run it in the "
        "session that shows the film: " +
        text_of(error));
  }
  check_portal();
  GVariantBuilder options;
  g_variant_builder_init(&options, G_VARIANT_TYPE_VARDICT);
  g_variant_builder_add(&options, "{sv}", "session_handle_token", g_variant_new_string("spidar"));
  const Ref<GVariant> created = ask("CreateSession", {}, options);
  const gchar* text = nullptr;
  if (!g_variant_lookup(created.get(), "session_handle", "&s", &text)) {
    refuse("the desktop's portal gives no session");
  }
  session_ = text;
  ended_signal_ = g_dbus_connection_signal_subscribe(
      bus_.get(), kPortal, kSession, "Closed", session_.c_str(), nullptr, G_DBUS_SIGNAL_FLAGS_NONE,
      set_true, &has_ended_, nullptr);

  // The mouse is hidden unless it is asked for.
  g_variant_builder_init(&options, G_VARIANT_TYPE_VARDICT);
  g_variant_builder_add(&options, "{sv}", "types", g_variant_new_uint32(kMonitor | kWindow));
  g_variant_builder_add(&options, "{sv}", "persist_mode", g_variant_new_uint32(kUntilRevoked));
  if (!token.empty()) {
    g_variant_builder_add(&options, "{sv}", "restore_token", g_variant_new_string(token.c_str()));
  }
  ask("SelectSources", {g_variant_new_object_path(session_.c_str())}, options);

  g_variant_builder_init(&options, G_VARIANT_TYPE_VARDICT);
  const Ref<GVariant> started = ask(
      "Start", {g_variant_new_object_path(session_.c_str()), g_variant_new_string("")}, options);
  if (g_variant_lookup(started.get(), "restore_token", "&s", &text)) token_ = text;
  const Ref<GVariant> streams(
      g_variant_lookup_value(started.get(), "streams", G_VARIANT_TYPE("a(ua{sv})")));
  if (!streams || g_variant_n_children(streams.get()) == 0) {
    refuse(
        "the desktop shares nothing, though it was allowed to: choose a screen or a window with "
        "spidar-feel --screen=ask");
  }
  GVariant* about = nullptr;
  g_variant_get_child(streams.get(), 0, "(u@a{sv})", &node_, &about);
  const Ref<GVariant> own(about);
  guint kind = kMonitor;
  g_variant_lookup(about, "source_type", "u", &kind);
  is_window_ = kind == kWindow;
  open_remote();
}

ScreenCast::~ScreenCast() {
  if (descriptor_ >= 0) close(descriptor_);
  if (ended_signal_) g_dbus_connection_signal_unsubscribe(bus_.get(), ended_signal_);
  if (!bus_ || session_.empty() || has_ended_) return;
  g_dbus_connection_call(bus_.get(), kPortal, session_.c_str(), kSession, "Close", nullptr, nullptr,
                         G_DBUS_CALL_FLAGS_NONE, -1, nullptr, nullptr, nullptr);
  g_dbus_connection_flush_sync(bus_.get(), nullptr, nullptr);
}

void ScreenCast::check_portal() {
  GError* error = nullptr;
  const Ref<GVariant> found(g_dbus_connection_call_sync(
      bus_.get(), kPortal, kPath, "org.freedesktop.DBus.Properties", "Get",
      g_variant_new("(ss)", kScreenCast, "version"), G_VARIANT_TYPE("(v)"), G_DBUS_CALL_FLAGS_NONE,
      kStart_ms, nullptr, &error));
  if (found) return;
  refuse(
      "this desktop has no portal that shares its screen: on Debian, the package "
      "xdg-desktop-portal with xdg-desktop-portal-gnome, -kde or -wlr has one: " +
      text_of(error));
}

Ref<GVariant> ScreenCast::call(const char* interface, const char* method, GVariant* arguments,
                               GUnixFDList** descriptors) const {
  GError* error = nullptr;
  Ref<GVariant> reply(g_dbus_connection_call_with_unix_fd_list_sync(
      bus_.get(), kPortal, kPath, interface, method, arguments, nullptr, G_DBUS_CALL_FLAGS_NONE,
      kStart_ms, nullptr, descriptors, nullptr, &error));
  if (!reply)
    refuse(std::string("the desktop's portal fails in ") + method + ": " + text_of(error));
  return reply;
}

Ref<GVariant> ScreenCast::ask(const char* method, std::vector<GVariant*> arguments,
                              GVariantBuilder& options) {
  // The answer may come before the call returns, so it is waited for by the path that it will have.
  std::string sender = g_dbus_connection_get_unique_name(bus_.get()) + 1;
  std::replace(sender.begin(), sender.end(), '.', '_');
  const std::string handle = std::string("spidar_") + method;
  const std::string path = std::string(kPath) + "/request/" + sender + "/" + handle;
  Answer answer;
  const guint answered = g_dbus_connection_signal_subscribe(
      bus_.get(), kPortal, kRequest, "Response", path.c_str(), nullptr, G_DBUS_SIGNAL_FLAGS_NONE,
      take_answer, &answer, nullptr);
  const guint gone = g_dbus_connection_signal_subscribe(
      bus_.get(), "org.freedesktop.DBus", "org.freedesktop.DBus", "NameOwnerChanged", nullptr,
      kPortal, G_DBUS_SIGNAL_FLAGS_NONE, take_owner, &answer, nullptr);
  g_variant_builder_add(&options, "{sv}", "handle_token", g_variant_new_string(handle.c_str()));
  arguments.push_back(g_variant_builder_end(&options));
  GVariant* const given = g_variant_new_tuple(arguments.data(), arguments.size());
  std::string failed;
  try {
    call(kScreenCast, method, given);
    while (!answer.is_there) g_main_context_iteration(nullptr, TRUE);
  } catch (const std::runtime_error& error) {
    failed = error.what();
  }
  g_dbus_connection_signal_unsubscribe(bus_.get(), answered);
  g_dbus_connection_signal_unsubscribe(bus_.get(), gone);
  if (!failed.empty()) refuse(failed);
  if (answer.status == kAllowed) return std::move(answer.results);
  refuse(answer.status == kCancelled
             ? "the desktop was not allowed to share its screen, so nothing is felt: allow it when "
               "it asks"
             : "the desktop's portal could not share the screen: its journal says why "
               "(journalctl --user -u xdg-desktop-portal)");
}

void ScreenCast::open_remote() {
  GVariantBuilder options;
  g_variant_builder_init(&options, G_VARIANT_TYPE_VARDICT);
  GUnixFDList* descriptors = nullptr;
  const Ref<GVariant> reply =
      call(kScreenCast, "OpenPipeWireRemote", g_variant_new("(oa{sv})", session_.c_str(), &options),
           &descriptors);
  const Ref<GUnixFDList> own(descriptors);
  gint32 index = -1;
  if (g_variant_is_of_type(reply.get(), G_VARIANT_TYPE("(h)"))) {
    g_variant_get(reply.get(), "(h)", &index);
  }
  if (descriptors) descriptor_ = g_unix_fd_list_get(descriptors, index, nullptr);
  if (descriptor_ < 0)
    refuse("the desktop's portal gives no connection to PipeWire: is it running?");
}

}  // namespace spidar::screen
