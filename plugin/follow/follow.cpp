// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/follow/follow.h"

#include <csignal>
#include <memory>
#include <stdexcept>
#include <utility>

#include <glib-unix.h>

#include "plugin/follow/followed_film.h"
#include "plugin/follow/mpris_player.h"
#include "plugin/follow/position_filter.h"
#include "plugin/gobject/ref.h"
#include "spidar/realtime/monotonic.h"

namespace spidar::follow {
namespace {

class Follower {
 public:
  Follower(GDBusConnection* bus, std::string name, std::vector<std::string> properties)
      : bus_(bus), name_(std::move(name)), properties_(std::move(properties)) {}

  void run(GMainLoop* loop) {
    const guint timer = g_timeout_add(kTick_ms, tick, this);
    g_main_loop_run(loop);
    g_source_remove(timer);
    film_.reset();
  }

 private:
  /// As often as the loop is told where playback is.
  static constexpr guint kTick_ms = 10;
  static constexpr int64_t kSearch_ns = 250'000'000;
  /// A player that tells no other position for so long stands still: it loads, or is stopped. VLC
  /// tells one each 0.37 s.
  static constexpr int64_t kStandstill_ns = 1'000'000'000;
  /// An answer takes a millisecond, and some tens of them where the machine is busy.
  static constexpr int64_t kNoAnswer_ns = 300'000'000;

  static gboolean tick(gpointer user) {
    auto& self = *static_cast<Follower*>(user);
    if (self.is_gone_) self.let_go();
    const int64_t now_ns = monotonic_now_ns();
    if (self.player_) {
      self.follow(now_ns);
    } else if (now_ns - self.searched_ns_ >= kSearch_ns) {
      self.search(now_ns);
    }
    return G_SOURCE_CONTINUE;
  }

  void search(int64_t now_ns) {
    searched_ns_ = now_ns;
    for (const std::string& found : list_players(bus_, name_)) {
      const auto state = ask_state(bus_, found);
      // Browsers play pages.
      const bool plays = state && state->status == PlayerState::Status::kPlaying &&
                         g_str_has_prefix(state->uri.c_str(), "file:");
      if (plays || (state && !name_.empty())) return take(found);
    }
    if (std::exchange(has_said_that_it_waits_, true)) return;
    tell(name_.empty()
             ? "waits for a player that plays a file: VLC, or mpv with the package mpv-mpris"
             : "waits for a player that is called " + name_ +
                   " in MPRIS; mpv needs the package mpv-mpris");
  }

  void take(const std::string& found) {
    tell("follows " + short_name(found));
    has_said_that_it_waits_ = is_gone_ = false;
    state_ = {};
    position_ns_ = 0;
    filter_ = PositionFilter();
    player_ = std::make_unique<Player>(
        bus_, found,
        Player::Told{[this](const PlayerState& state) { take_state(state); },
                     [this](int64_t now_ns, int64_t position_ns) {
                       filter_.tell(now_ns, position_ns);
                       take_position(now_ns, position_ns);
                     },
                     [this](int64_t now_ns, int64_t position_ns) {
                       filter_.tell_jump(now_ns, position_ns);
                       take_position(now_ns, position_ns);
                     },
                     [this] {
                       if (film_) film_->rest(position_ns_);
                       is_gone_ = true;
                     }});
  }

  /// Not in a callback of the player, which ends here.
  void let_go() {
    is_gone_ = false;
    tell(short_name(player_->bus_name()) + " has ended");
    film_.reset();
    uri_.clear();
    player_.reset();
  }

  void take_state(const PlayerState& state) {
    const bool plays = state.status == PlayerState::Status::kPlaying;
    const bool begins = plays && state_.status != state.status;
    if (plays && filter_.has_begun() && state.rate != state_.rate) {
      filter_.change_rate(monotonic_now_ns(), state.rate);
    }
    state_ = state;
    if (begins) is_beginning_ = true;
    if (begins && state.uri.empty()) {
      tell(short_name(player_->bus_name()) + " does not say which file it plays");
    }
    if (!plays) {
      is_beginning_ = false;
      filter_ = PositionFilter();
      if (film_) film_->rest(position_ns_);
    }
    const bool stopped = state.status == PlayerState::Status::kStopped;
    if (stopped || state.uri != uri_) change_film(stopped ? "" : state.uri);
  }

  void take_position(int64_t now_ns, int64_t position_ns) {
    position_ns_ = position_ns;
    if (!std::exchange(is_beginning_, false)) return;
    filter_.reset(now_ns, position_ns, state_.rate);
  }

  void change_film(const std::string& uri) {
    uri_ = uri;
    film_.reset();
    if (uri.empty()) return;
    try {
      film_ = std::make_unique<FollowedFilm>(uri, properties_);
    } catch (const std::runtime_error& error) {
      tell(uri + ": " + error.what());
    }
    is_beginning_ = state_.status == PlayerState::Status::kPlaying;
  }

  void follow(int64_t now_ns) {
    if (!film_) return;
    if (!film_->check()) {
      tell("without force until the next film: " + uri_);
      return film_.reset();
    }
    const bool stands =
        now_ns - filter_.newest_ns() > kStandstill_ns || player_->silent_ns() > kNoAnswer_ns;
    if (state_.status != PlayerState::Status::kPlaying || stands) return film_->rest(position_ns_);
    if (!filter_.has_begun()) return;
    film_->follow(now_ns, filter_.position_at(now_ns) - lead_ns(), state_.rate);
  }

  /// mpv tells the position of the picture that it shows next.
  int64_t lead_ns() const {
    return short_name(player_->bus_name()) == "mpv" ? film_->frame_ns() : 0;
  }

  GDBusConnection* const bus_;
  const std::string name_;
  const std::vector<std::string> properties_;
  int64_t searched_ns_ = 0;
  bool has_said_that_it_waits_ = false;
  std::unique_ptr<Player> player_;
  bool is_gone_ = false;
  PlayerState state_;
  std::string uri_;
  std::unique_ptr<FollowedFilm> film_;
  int64_t position_ns_ = 0;    ///< the newest that it told
  bool is_beginning_ = false;  ///< the next position begins a playback
  PositionFilter filter_;
};

gboolean quit(gpointer loop) {
  g_main_loop_quit(static_cast<GMainLoop*>(loop));
  return G_SOURCE_CONTINUE;
}

void lose_bus(GDBusConnection*, gboolean, GError*, gpointer loop) {
  tell("the session bus has ended");
  quit(loop);
}

}  // namespace

int run(const std::string& name, const std::vector<std::string>& properties) {
  GError* error = nullptr;
  const Ref<GDBusConnection> bus(g_bus_get_sync(G_BUS_TYPE_SESSION, nullptr, &error));
  if (!bus) {
    tell(std::string("there is no session bus, by which players are followed: ") + error->message);
    g_clear_error(&error);
    return 1;
  }
  g_dbus_connection_set_exit_on_close(bus.get(), FALSE);
  GMainLoop* const loop = g_main_loop_new(nullptr, FALSE);
  g_signal_connect(bus.get(), "closed", G_CALLBACK(lose_bus), loop);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) g_unix_signal_add(number, quit, loop);
  Follower(bus.get(), name, properties).run(loop);
  g_main_loop_unref(loop);
  return 0;
}

}  // namespace spidar::follow
