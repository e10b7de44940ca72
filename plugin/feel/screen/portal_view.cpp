// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Screens and windows from the desktop's portal, org.freedesktop.portal.ScreenCast.
//
// libportal 0.6 does not suffice: it waits for ever for an answer of another type and for a portal
// that has ended, and does not report why there is no connection to PipeWire.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gio/gunixfdlist.h>
#include <initializer_list>
#include <optional>
#include <poll.h>
#include <stdexcept>
#include <system_error>
#include <unistd.h>
#include <utility>
#include <vector>

#include "plugin/feel/screen/portal_answers.h"
#include "plugin/feel/screen/view.h"

namespace spidar::screen {
namespace {

constexpr const char* kPortal = "org.freedesktop.portal.Desktop";
constexpr const char* kPath = "/org/freedesktop/portal/desktop";
constexpr const char* kScreenCast = "org.freedesktop.portal.ScreenCast";
constexpr const char* kRequest = "org.freedesktop.portal.Request";
constexpr const char* kSession = "org.freedesktop.portal.Session";
/// A value of the interface's `persist_mode`.
constexpr guint kUntilRevoked = 2;
/// The limit for the first answer: the bus starts the portal, which starts that of the desktop.
constexpr int kStart_ms = 25'000;

struct NotAllowed : std::runtime_error {
  using std::runtime_error::runtime_error;
};

[[noreturn]] void refuse(const std::string& what) {
  throw std::runtime_error(what);
}

std::string message_of(GError* error) {
  const std::string text = error ? error->message : "it does not answer";
  g_clear_error(&error);
  return text;
}

void on_answer(GDBusConnection*, const gchar*, const gchar*, const gchar*, const gchar*,
               GVariant* parameters, gpointer answer) {
  static_cast<std::optional<PortalAnswer>*>(answer)->emplace(parameters);
}

/// Ends the wait when the portal exits, because it then answers no call.
void on_owner_changed(GDBusConnection*, const gchar*, const gchar*, const gchar*, const gchar*,
                      GVariant* parameters, gpointer answer) {
  const gchar* owner = "";
  if (read_variant(parameters, "(&s&s&s)", nullptr, nullptr, &owner) && !*owner) {
    static_cast<std::optional<PortalAnswer>*>(answer)->emplace();
  }
}

void set_true(GDBusConnection*, const gchar*, const gchar*, const gchar*, const gchar*, GVariant*,
              gpointer flag) {
  *static_cast<bool*>(flag) = true;
}

namespace fs = std::filesystem;

/// The file with the desktop's token for the last permission of the user.
fs::path token_file() {
  return fs::path(g_get_user_state_dir()) / "gst-spidar" / "screen-token";
}

std::string read_token() {
  std::string token;
  std::getline(std::ifstream(token_file()), token);
  return token;
}

/// Without the token, the desktop asks again, so a file that cannot be written is no error.
void write_token(const std::string& token) {
  std::error_code error;
  if (token.empty()) {
    fs::remove(token_file(), error);
    return;
  }
  fs::create_directories(token_file().parent_path(), error);
  fs::permissions(token_file().parent_path(), fs::perms::owner_all, error);
  std::ofstream(token_file(), std::ios::trunc) << token << '\n';
}

/// A shared screen or window, which the user allows in a dialog of the desktop. Iterates the main
/// context while it waits.
class PortalView final : public View {
 public:
  /// `token` is that of an earlier permission; the desktop then asks only if the token is void.
  /// With an empty token, the desktop asks.
  explicit PortalView(const std::string& token);
  ~PortalView() override { end(); }
  PortalView(const PortalView&) = delete;
  PortalView& operator=(const PortalView&) = delete;

  std::string name() const override {
    return shared_.is_window ? "the window that the desktop shares"
                             : "the screen that the desktop shares";
  }
  Ref<GstElement> make_source() override;
  std::string change() override {
    if (is_without_pipewire()) return "PipeWire has ended: start spidar-feel --screen again";
    return has_ended_ ? "the desktop has ended the sharing" : "";
  }
  bool has_ended() const override { return has_ended_ || is_without_pipewire(); }

 private:
  using Option = std::pair<const char*, GVariant*>;

  PortalView() = default;
  void share(const std::string& token);
  void open_remote();
  void end();
  /// Calls a method of the session that answers by a Request, and returns its results. `arguments`
  /// and options are floating.
  Ref<GVariant> ask(const char* method, std::vector<GVariant*> arguments,
                    std::initializer_list<Option> options);
  Ref<GVariant> call(const char* method, GVariant* arguments,
                     GUnixFDList** descriptors = nullptr) const;
  /// Whether PipeWire has closed the connection. pipewiresrc does not end by itself then.
  bool is_without_pipewire() const {
    pollfd remote{descriptor_, 0, 0};
    return poll(&remote, 1, 0) > 0;
  }

  Ref<GDBusConnection> bus_;
  std::string session_;  ///< object path; empty: there is none
  guint ended_signal_ = 0;
  bool has_ended_ = false;  ///< the desktop or the user has ended it
  Shared shared_;
  int descriptor_ = -1;  ///< for a PipeWire client
};

PortalView::PortalView(const std::string& token) : PortalView() {
  GError* error = nullptr;
  bus_.reset(g_bus_get_sync(G_BUS_TYPE_SESSION, nullptr, &error));
  if (!bus_) {
    refuse(
        "there is no session bus, on which the desktop is asked for its screen: run it in the "
        "session that shows the film: " +
        message_of(error));
  }
  try {
    share(token);
  } catch (const NotAllowed&) {
    throw;
  } catch (const std::runtime_error&) {
    if (token.empty()) throw;
    // The token may be void, which portals report in several ways.
    end();
    share("");
  }
  open_remote();
  write_token(shared_.token);
}

void PortalView::share(const std::string& token) {
  const Ref<GVariant> created =
      ask("CreateSession", {}, {{"session_handle_token", g_variant_new_string("spidar")}});
  session_ = session_in(created.get());
  if (session_.empty()) refuse("the desktop's portal names no session");
  has_ended_ = false;
  ended_signal_ = g_dbus_connection_signal_subscribe(
      bus_.get(), kPortal, kSession, "Closed", session_.c_str(), nullptr, G_DBUS_SIGNAL_FLAGS_NONE,
      set_true, &has_ended_, nullptr);
  GVariant* const session = g_variant_new_object_path(session_.c_str());
  const Ref<GVariant> own(g_variant_ref_sink(session));
  // By default the mouse is hidden.
  const Option types{"types", g_variant_new_uint32(Shared::kMonitor | Shared::kWindow)};
  const Option persist{"persist_mode", g_variant_new_uint32(kUntilRevoked)};
  if (token.empty()) {
    ask("SelectSources", {session}, {types, persist});
  } else {
    ask("SelectSources", {session},
        {types, persist, {"restore_token", g_variant_new_string(token.c_str())}});
  }
  shared_ = Shared(ask("Start", {session, g_variant_new_string("")}, {}).get());
  if (shared_.is_something) return;
  refuse(
      "the desktop shares nothing, though it was allowed to: choose a screen or a window with "
      "spidar-feel --screen=ask");
}

void PortalView::end() {
  if (descriptor_ >= 0) close(descriptor_);
  descriptor_ = -1;
  if (session_.empty()) return;
  g_dbus_connection_signal_unsubscribe(bus_.get(), ended_signal_);
  if (!has_ended_) {
    g_dbus_connection_call(bus_.get(), kPortal, session_.c_str(), kSession, "Close", nullptr,
                           nullptr, G_DBUS_CALL_FLAGS_NONE, -1, nullptr, nullptr, nullptr);
    g_dbus_connection_flush_sync(bus_.get(), nullptr, nullptr);
  }
  session_.clear();
}

Ref<GVariant> PortalView::call(const char* method, GVariant* arguments,
                               GUnixFDList** descriptors) const {
  GError* error = nullptr;
  Ref<GVariant> reply(g_dbus_connection_call_with_unix_fd_list_sync(
      bus_.get(), kPortal, kPath, kScreenCast, method, arguments, nullptr, G_DBUS_CALL_FLAGS_NONE,
      kStart_ms, nullptr, descriptors, nullptr, &error));
  if (reply) return reply;
  refuse((session_.empty() ? "this desktop has no portal that shares its screen: on Debian, the "
                             "package xdg-desktop-portal with xdg-desktop-portal-gnome, -kde or "
                             "-wlr has one: "
                           : "the desktop's portal fails in " + std::string(method) + ": ") +
         message_of(error));
}

Ref<GVariant> PortalView::ask(const char* method, std::vector<GVariant*> arguments,
                              std::initializer_list<Option> options) {
  // The answer may come before the call returns, so subscribe to the expected path first.
  std::string sender = g_dbus_connection_get_unique_name(bus_.get()) + 1;
  std::replace(sender.begin(), sender.end(), '.', '_');
  const std::string handle = std::string("spidar_") + method;
  const std::string path = std::string(kPath) + "/request/" + sender + "/" + handle;
  GVariantBuilder given;
  g_variant_builder_init(&given, G_VARIANT_TYPE_VARDICT);
  for (const auto& [name, value] : options) g_variant_builder_add(&given, "{sv}", name, value);
  g_variant_builder_add(&given, "{sv}", "handle_token", g_variant_new_string(handle.c_str()));
  arguments.push_back(g_variant_builder_end(&given));

  std::optional<PortalAnswer> answer;
  const guint answered = g_dbus_connection_signal_subscribe(
      bus_.get(), kPortal, kRequest, "Response", path.c_str(), nullptr, G_DBUS_SIGNAL_FLAGS_NONE,
      on_answer, &answer, nullptr);
  const guint gone = g_dbus_connection_signal_subscribe(
      bus_.get(), "org.freedesktop.DBus", "org.freedesktop.DBus", "NameOwnerChanged", nullptr,
      kPortal, G_DBUS_SIGNAL_FLAGS_NONE, on_owner_changed, &answer, nullptr);
  std::string failed;
  try {
    call(method, g_variant_new_tuple(arguments.data(), arguments.size()));
    while (!answer) g_main_context_iteration(nullptr, TRUE);
  } catch (const std::runtime_error& error) {
    failed = error.what();
  }
  g_dbus_connection_signal_unsubscribe(bus_.get(), answered);
  g_dbus_connection_signal_unsubscribe(bus_.get(), gone);
  if (!failed.empty()) refuse(failed);
  if (answer->status == PortalAnswer::kAllowed) return std::move(answer->results);
  if (answer->status == PortalAnswer::kCancelled) {
    throw NotAllowed(
        "the desktop was not allowed to share its screen, so nothing is felt: allow it when it "
        "asks");
  }
  refuse(
      "the desktop's portal could not share the screen: its journal says why (journalctl --user "
      "-u xdg-desktop-portal)");
}

void PortalView::open_remote() {
  GVariantBuilder options;
  g_variant_builder_init(&options, G_VARIANT_TYPE_VARDICT);
  GUnixFDList* descriptors = nullptr;
  const Ref<GVariant> reply = call(
      "OpenPipeWireRemote", g_variant_new("(oa{sv})", session_.c_str(), &options), &descriptors);
  const Ref<GUnixFDList> own(descriptors);
  gint32 index = -1;
  read_variant(reply.get(), "(h)", &index);
  const bool is_there = descriptors && index >= 0 && index < g_unix_fd_list_get_length(descriptors);
  if (is_there) descriptor_ = g_unix_fd_list_get(descriptors, index, nullptr);
  if (descriptor_ < 0) {
    refuse("the desktop's portal gives no connection to PipeWire: is it running?");
  }
}

Ref<GstElement> PortalView::make_source() {
  // Accept system memory only: a source that prefers other memory then offers it, too.
  const std::string line = "pipewiresrc do-timestamp=true fd=" + std::to_string(descriptor_) +
                           " path=" + std::to_string(shared_.node) +
                           " ! capsfilter caps=video/x-raw";
  GError* error = nullptr;
  Ref<GstElement> source = sunk(gst_parse_bin_from_description(line.c_str(), TRUE, &error));
  g_clear_error(&error);
  if (source) return source;
  refuse(
      "GStreamer's pipewiresrc, which takes what the desktop shares, is missing: Debian has it in "
      "gstreamer1.0-pipewire");
}

}  // namespace

std::unique_ptr<View> view_of_portal(bool is_asked) {
  return std::make_unique<PortalView>(is_asked ? "" : read_token());
}

}  // namespace spidar::screen
