// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/feel/follow/mpris_player.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <utility>

#include "plugin/gobject/ref.h"
#include "spidar/realtime/monotonic.h"

namespace spidar::follow {
namespace {

constexpr const char* kPrefix = "org.mpris.MediaPlayer2.";
constexpr const char* kPath = "/org/mpris/MediaPlayer2";
constexpr const char* kPlayer = "org.mpris.MediaPlayer2.Player";
constexpr const char* kProperties = "org.freedesktop.DBus.Properties";
/// The track ID that players without a track list report. SetPosition needs a track list.
constexpr const char* kNoTrack = "/org/mpris/MediaPlayer2/TrackList/NoTrack";
constexpr const char* kBus = "org.freedesktop.DBus";
/// More than a person has; each player is queried once a second.
constexpr size_t kMaxPlayers = 64;

/// The result of a call: a value, the reason why there is none, or neither after another error.
struct Answer {
  Ref<GVariant> reply;
  bool is_cancelled = false;  ///< the caller is destroyed
  bool is_gone = false;       ///< the player is gone
  bool is_refused = false;    ///< the player has answered with an error
};

Answer finish(GObject* bus, GAsyncResult* result) {
  g_autoptr(GError) error = nullptr;
  Answer answer;
  answer.reply.reset(g_dbus_connection_call_finish(G_DBUS_CONNECTION(bus), result, &error));
  if (!error) return answer;
  answer.is_cancelled = g_error_matches(error, G_IO_ERROR, G_IO_ERROR_CANCELLED);
  answer.is_gone = g_error_matches(error, G_DBUS_ERROR, G_DBUS_ERROR_NAME_HAS_NO_OWNER) ||
                   g_error_matches(error, G_DBUS_ERROR, G_DBUS_ERROR_SERVICE_UNKNOWN);
  answer.is_refused = !answer.is_gone && g_dbus_error_is_remote_error(error) &&
                      !g_error_matches(error, G_DBUS_ERROR, G_DBUS_ERROR_NO_REPLY);
  return answer;
}

GVariant* all_of_player() {
  return g_variant_new("(s)", kPlayer);
}

PlayerState state_of(GVariant* properties) {
  PlayerState state;
  const gchar* text = nullptr;
  if (g_variant_lookup(properties, "PlaybackStatus", "&s", &text)) {
    if (g_str_equal(text, "Playing")) state.status = PlayerStatus::kPlaying;
    if (g_str_equal(text, "Paused")) state.status = PlayerStatus::kPaused;
  }
  // The range of mpv; a number outside counts as ordinary playback.
  constexpr double kMin = 0.01, kMax = 100;
  double rate = 0;
  if (g_variant_lookup(properties, "Rate", "d", &rate) && rate >= kMin && rate <= kMax) {
    state.rate = rate;
  }
  const Ref<GVariant> metadata(
      g_variant_lookup_value(properties, "Metadata", G_VARIANT_TYPE_VARDICT));
  // Longer addresses name no file, and would stay in memory.
  constexpr size_t kMaxUri = 64 << 10;
  if (metadata && g_variant_lookup(metadata.get(), "xesam:url", "&s", &text) &&
      std::strlen(text) <= kMaxUri) {
    state.uri = text;
  }
  if (metadata &&
      (g_variant_lookup(metadata.get(), "mpris:trackid", "&o", &text) ||
       g_variant_lookup(metadata.get(), "mpris:trackid", "&s", &text)) &&
      std::strlen(text) <= kMaxUri) {
    state.track = text;
  }
  const auto may = [&](const char* what) {
    gboolean can = TRUE;
    return !g_variant_lookup(properties, what, "b", &can) || can;
  };
  state.can_pause = may("CanControl") && may("CanPause");
  state.can_seek = may("CanControl") && may("CanSeek");
  return state;
}

/// Limits the position to one year, because a player may report any number.
int64_t ns_of(gint64 position_us) {
  constexpr gint64 kMax_us = 1'000'000 * gint64{365 * 24 * 3600};
  return 1000 * std::clamp(position_us, -kMax_us, kMax_us);
}

std::optional<PlayerState> state_in(GVariant* reply) {
  if (!reply || !g_variant_is_of_type(reply, G_VARIANT_TYPE("(a{sv})"))) return std::nullopt;
  const Ref<GVariant> properties(g_variant_get_child_value(reply, 0));
  return state_of(properties.get());
}

}  // namespace

std::string short_name(const std::string& bus_name) {
  const std::string name = bus_name.substr(std::string(kPrefix).size());
  const size_t instance = name.find(".instance");
  return name.substr(0, instance);
}

void list_players(GDBusConnection* bus, const std::string& name, GCancellable* ended,
                  std::function<void(std::optional<std::vector<std::string>>)> take) {
  struct Query {
    std::string name;
    std::function<void(std::optional<std::vector<std::string>>)> take;
  };
  const auto answered = [](GObject* source, GAsyncResult* result, gpointer user) {
    const std::unique_ptr<Query> query(static_cast<Query*>(user));
    const Answer answer = finish(source, result);
    if (answer.is_cancelled) return;
    if (!answer.reply || !g_variant_is_of_type(answer.reply.get(), G_VARIANT_TYPE("(as)"))) {
      return query->take(std::nullopt);
    }
    std::vector<std::string> found;
    GVariantIter* names = nullptr;
    g_variant_get(answer.reply.get(), "(as)", &names);
    const std::string wanted = kPrefix + query->name;
    for (const gchar* each = nullptr; g_variant_iter_next(names, "&s", &each);) {
      const bool is_wanted = query->name.empty()
                                 ? g_str_has_prefix(each, kPrefix)
                                 : each == wanted || g_str_has_prefix(each, (wanted + ".").c_str());
      if (is_wanted && found.size() < kMaxPlayers) found.emplace_back(each);
    }
    g_variant_iter_free(names);
    query->take(std::move(found));
  };
  g_dbus_connection_call(bus, kBus, "/org/freedesktop/DBus", kBus, "ListNames", nullptr, nullptr,
                         G_DBUS_CALL_FLAGS_NO_AUTO_START, kAnswer_ms, ended, answered,
                         new Query{name, std::move(take)});
}

Player::Player(GDBusConnection* bus, const std::string& bus_name, Callbacks callbacks)
    : bus_(bus),
      bus_name_(bus_name),
      callbacks_(std::move(callbacks)),
      ended_(g_cancellable_new()) {
  const auto subscribe = [this](const char* sender, const char* interface, const char* signal,
                                const char* path, const char* argument, GDBusSignalCallback take) {
    signals_.push_back(g_dbus_connection_signal_subscribe(bus_, sender, interface, signal, path,
                                                          argument, G_DBUS_SIGNAL_FLAGS_NONE, take,
                                                          this, nullptr));
  };
  subscribe(bus_name_.c_str(), kProperties, "PropertiesChanged", kPath, kPlayer, on_signal);
  subscribe(bus_name_.c_str(), kPlayer, "Seeked", kPath, nullptr, on_signal);
  subscribe(kBus, kBus, "NameOwnerChanged", nullptr, bus_name_.c_str(), on_owner_changed);
  timer_ = g_timeout_add(kPoll_ms, poll, this);
  request_state();
}

Player::~Player() {
  g_source_remove(timer_);
  for (const guint signal : signals_) g_dbus_connection_signal_unsubscribe(bus_, signal);
  g_cancellable_cancel(ended_);
  g_object_unref(ended_);
}

void Player::watch(bool wanted) {
  is_watched_ = wanted;
}

int64_t Player::silent_ns() const {
  return requested_ns_ == 0 ? 0 : monotonic_now_ns() - requested_ns_;
}

gboolean Player::poll(gpointer user) {
  auto& self = *static_cast<Player*>(user);
  if (self.is_gone_) return G_SOURCE_CONTINUE;
  if (self.is_watched_ && self.requested_ns_ == 0) self.request_position();
  if (monotonic_now_ns() - self.state_requested_ns_ > kAskState_ns) self.request_state();
  return G_SOURCE_CONTINUE;
}

void Player::call(const char* method, GVariant* parameters, GAsyncReadyCallback take) {
  g_dbus_connection_call(bus_, bus_name_.c_str(), kPath, kProperties, method, parameters, nullptr,
                         G_DBUS_CALL_FLAGS_NO_AUTO_START, kAnswer_ms, ended_, take, this);
}

void Player::order(const char* method, GVariant* parameters) {
  g_dbus_connection_call(bus_, bus_name_.c_str(), kPath, kPlayer, method, parameters, nullptr,
                         G_DBUS_CALL_FLAGS_NO_AUTO_START, kAnswer_ms, ended_, on_order_answer,
                         this);
}

void Player::toggle() {
  order("PlayPause", nullptr);
}

void Player::seek(int64_t position_ns, int64_t distance_ns) {
  const std::string& track = state_->track;
  if (g_variant_is_object_path(track.c_str()) && track != kNoTrack) {
    order("SetPosition", g_variant_new("(ox)", track.c_str(), position_ns / 1000));
  } else {
    order("Seek", g_variant_new("(x)", distance_ns / 1000));
  }
}

void Player::on_order_answer(GObject* bus, GAsyncResult* result, gpointer user) {
  const Answer answer = finish(bus, result);
  if (answer.is_cancelled) return;
  auto& self = *static_cast<Player*>(user);
  if (answer.is_refused) self.callbacks_.refusal(self);
}

void Player::request_position() {
  requested_ns_ = monotonic_now_ns();
  call("Get", g_variant_new("(ss)", kPlayer, "Position"), on_position);
}

/// Sends one query at a time, however many changes a player reports.
void Player::request_state() {
  state_changed_ = state_waits_;
  if (std::exchange(state_waits_, true)) return;
  state_requested_ns_ = monotonic_now_ns();
  call("GetAll", all_of_player(), on_state);
}

/// A player reads its position and then answers, so the position is late, never early.
void Player::on_position(GObject* bus, GAsyncResult* result, gpointer user) {
  const Answer answer = finish(bus, result);
  if (answer.is_cancelled) return;
  auto& self = *static_cast<Player*>(user);
  self.requested_ns_ = 0;
  // The player ended before this program listened for its end.
  self.is_gone_ = self.is_gone_ || answer.is_gone;
  GVariant* const reply = answer.reply.get();
  if (!reply) {
    if (answer.is_refused) self.has_position_ = false;
    return;
  }
  if (!g_variant_is_of_type(reply, G_VARIANT_TYPE("(v)"))) return;
  GVariant* inner = nullptr;
  g_variant_get(reply, "(v)", &inner);
  const Ref<GVariant> position(inner);
  self.has_position_ = g_variant_is_of_type(inner, G_VARIANT_TYPE_INT64) != FALSE;
  if (self.has_position_ && self.is_watched_) {
    self.callbacks_.position(monotonic_now_ns(), ns_of(g_variant_get_int64(inner)));
  }
}

void Player::on_state(GObject* bus, GAsyncResult* result, gpointer user) {
  const Answer answer = finish(bus, result);
  if (answer.is_cancelled) return;
  auto& self = *static_cast<Player*>(user);
  self.state_waits_ = false;
  self.is_gone_ = self.is_gone_ || answer.is_gone;
  if (std::exchange(self.state_changed_, false)) self.request_state();
  auto state = state_in(answer.reply.get());
  if (!state) return;
  self.state_ = std::move(state);
  self.callbacks_.state(self);
}

void Player::on_signal(GDBusConnection*, const gchar*, const gchar*, const gchar*,
                       const gchar* name, GVariant* parameters, gpointer user) {
  auto& self = *static_cast<Player*>(user);
  if (!g_str_equal(name, "Seeked")) {
    self.request_state();  // the signal has only a part of the state
  } else if (self.is_watched_ && g_variant_is_of_type(parameters, G_VARIANT_TYPE("(x)"))) {
    gint64 position_us = 0;
    g_variant_get(parameters, "(x)", &position_us);
    self.callbacks_.jump(monotonic_now_ns(), ns_of(position_us));
  }
}

void Player::on_owner_changed(GDBusConnection*, const gchar*, const gchar*, const gchar*,
                              const gchar*, GVariant* parameters, gpointer user) {
  const gchar* before = nullptr;
  g_variant_get(parameters, "(&s&s&s)", nullptr, &before, nullptr);
  // A player that gets the name while nobody has it is new, and is queried.
  if (*before != '\0') static_cast<Player*>(user)->is_gone_ = true;
}

}  // namespace spidar::follow
