// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/device/card_reservation.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

namespace spidar {
namespace {

constexpr const char* kInterface = "org.freedesktop.ReserveDevice1";
constexpr const char* kBus = "org.freedesktop.DBus";
/// By the protocol, an owner with the highest priority need not release the card.
constexpr gint32 kPriority = std::numeric_limits<gint32>::max();

/// Flags and results of RequestName in the D-Bus specification.
constexpr guint32 kReplace = 2, kDoNotQueue = 4, kIsOwner = 1;

/// Returns an empty string if there is no bus. GLib's own look-up would start one.
std::string bus_address() {
  const gchar* const address = secure_getenv("DBUS_SESSION_BUS_ADDRESS");
  if (address) return address;
  g_autofree gchar* socket = g_build_filename(g_get_user_runtime_dir(), "bus", nullptr);
  return g_file_test(socket, G_FILE_TEST_EXISTS) ? std::string("unix:path=") + socket : "";
}

/// Returns null, with the reason in `error`, if the bus does not answer in `limit_ms`: a bus may
/// accept a connection and never answer. Uses its own main context, because there may be no main
/// loop, or the caller may be in the thread of that loop.
Ref<GDBusConnection> connect(const std::string& address, int limit_ms, std::string& error) {
  struct Answer {
    bool is_there = false;
    Ref<GDBusConnection> bus;
    std::string error;
  };
  constexpr auto kFlags =
      static_cast<GDBusConnectionFlags>(G_DBUS_CONNECTION_FLAGS_AUTHENTICATION_CLIENT |
                                        G_DBUS_CONNECTION_FLAGS_MESSAGE_BUS_CONNECTION);
  const auto take = [](GObject*, GAsyncResult* result, gpointer user) {
    const std::unique_ptr<std::shared_ptr<Answer>> own(static_cast<std::shared_ptr<Answer>*>(user));
    Answer& answer = **own;
    g_autoptr(GError) failed = nullptr;
    answer.bus.reset(g_dbus_connection_new_for_address_finish(result, &failed));
    if (failed) answer.error = failed->message;
    answer.is_there = true;
  };
  const auto ring = [](gpointer is_late) -> gboolean {
    *static_cast<bool*>(is_late) = true;
    return G_SOURCE_REMOVE;
  };
  g_autoptr(GMainContext) context = g_main_context_new();
  g_autoptr(GCancellable) cancelled = g_cancellable_new();
  g_autoptr(GSource) alarm = g_timeout_source_new(static_cast<guint>(limit_ms));
  bool is_late = false;
  // GIO cannot cancel every step of a connection, so its answer may come after the wait.
  const auto answer = std::make_shared<Answer>();
  g_main_context_push_thread_default(context);
  g_source_set_callback(alarm, ring, &is_late, nullptr);
  g_source_attach(alarm, context);
  // A private connection does not end the process when the bus ends.
  g_dbus_connection_new_for_address(address.c_str(), kFlags, nullptr, cancelled, take,
                                    new std::shared_ptr<Answer>(answer));
  while (!answer->is_there && !is_late) g_main_context_iteration(context, TRUE);
  g_source_destroy(alarm);
  g_cancellable_cancel(cancelled);
  g_main_context_pop_thread_default(context);
  error = answer->is_there ? answer->error : "the session bus does not answer";
  return std::move(answer->bus);
}

std::string numbered(std::string name, int card) {
  name += std::to_string(card);
  return name;
}

}  // namespace

CardReservation::CardReservation(int card)
    : name_(numbered("org.freedesktop.ReserveDevice1.Audio", card)),
      path_(numbered("/org/freedesktop/ReserveDevice1/Audio", card)),
      until_us_(g_get_monotonic_time() + gint64{1000} * kAnswerTimeout_ms) {}

int CardReservation::left_ms() const {
  const gint64 left_us = until_us_ - g_get_monotonic_time();
  return static_cast<int>(std::clamp<gint64>(left_us / 1000, 1, kAnswerTimeout_ms));
}

CardReservation::~CardReservation() {
  if (!bus_) return;
  constexpr gint64 kGoodbye_us = 500'000;
  until_us_ = g_get_monotonic_time() + kGoodbye_us;
  std::string refused;
  call(kBus, "/org/freedesktop/DBus", kBus, "ReleaseName", g_variant_new("(s)", name_.c_str()),
       "(u)", refused);
  g_dbus_connection_close(bus_.get(), nullptr, nullptr, nullptr);  // does not wait
}

std::unique_ptr<CardReservation> CardReservation::reserve(int card, std::string& refused) {
  refused.clear();
  const std::string address = bus_address();
  if (address.empty()) return nullptr;
  std::unique_ptr<CardReservation> taken(new CardReservation(card));
  taken->bus_ = connect(address, taken->left_ms(), refused);
  if (!taken->bus_) return nullptr;
  // GDBus may still call the filter while the reservation is destroyed.
  g_dbus_connection_add_filter(taken->bus_.get(), answer, new std::string(taken->path_),
                               [](gpointer path) { delete static_cast<std::string*>(path); });
  if (taken->request_name(kDoNotQueue, refused)) return taken;
  if (refused.empty() && taken->request_release(refused) &&
      taken->request_name(kDoNotQueue | kReplace, refused)) {
    return taken;
  }
  if (refused.empty()) refused = "its owner keeps it";
  return nullptr;
}

/// Returns false, without a reason, if another process has the card.
bool CardReservation::request_name(guint32 flags, std::string& refused) const {
  const Ref<GVariant> result = call(kBus, "/org/freedesktop/DBus", kBus, "RequestName",
                                    g_variant_new("(su)", name_.c_str(), flags), "(u)", refused);
  guint32 code = 0;
  if (result) g_variant_get(result.get(), "(u)", &code);
  return code == kIsOwner;
}

bool CardReservation::request_release(std::string& refused) const {
  const Ref<GVariant> result = call(name_.c_str(), path_.c_str(), kInterface, "RequestRelease",
                                    g_variant_new("(i)", kPriority), "(b)", refused);
  gboolean given = FALSE;
  if (result) g_variant_get(result.get(), "(b)", &given);
  return given != FALSE;
}

Ref<GVariant> CardReservation::call(const char* to, const char* path, const char* interface,
                                    const char* method, GVariant* arguments,
                                    const char* result_type, std::string& refused) const {
  g_autoptr(GError) error = nullptr;
  Ref<GVariant> result(g_dbus_connection_call_sync(
      bus_.get(), to, path, interface, method, arguments, G_VARIANT_TYPE(result_type),
      G_DBUS_CALL_FLAGS_NO_AUTO_START, left_ms(), nullptr, &error));
  if (!result) refused = error->message;
  return result;
}

/// Answers requests for the card, in GDBus' own thread. GDBus answers other calls with an error.
GDBusMessage* CardReservation::answer(GDBusConnection* bus, GDBusMessage* message,
                                      gboolean incoming, gpointer path) {
  const bool is_asked =
      incoming && g_dbus_message_get_message_type(message) == G_DBUS_MESSAGE_TYPE_METHOD_CALL &&
      g_strcmp0(g_dbus_message_get_path(message), static_cast<std::string*>(path)->c_str()) == 0;
  if (!is_asked) return message;
  const char* const method = g_dbus_message_get_member(message);
  GVariant* const body = g_dbus_message_get_body(message);
  GVariant* result = nullptr;
  const auto property = [](const char* name) -> GVariant* {
    if (std::strcmp(name, "Priority") == 0) return g_variant_new_int32(kPriority);
    if (std::strcmp(name, "ApplicationName") == 0) return g_variant_new_string("gst-spidar");
    if (std::strcmp(name, "ApplicationDeviceName") == 0) return g_variant_new_string("shaker");
    return nullptr;
  };
  if (g_strcmp0(method, "RequestRelease") == 0) {
    result = g_variant_new("(b)", FALSE);
  } else if (g_strcmp0(method, "Get") == 0 && body &&
             g_variant_is_of_type(body, G_VARIANT_TYPE("(ss)"))) {
    const char* name = nullptr;
    g_variant_get(body, "(&s&s)", nullptr, &name);
    GVariant* const value = property(name);
    if (value) result = g_variant_new("(v)", value);
  }
  if (!result) return message;
  g_autoptr(GDBusMessage) reply = g_dbus_message_new_method_reply(message);
  g_dbus_message_set_body(reply, result);
  g_dbus_connection_send_message(bus, reply, G_DBUS_SEND_MESSAGE_FLAGS_NONE, nullptr, nullptr);
  g_object_unref(message);
  return nullptr;
}

}  // namespace spidar
