// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <functional>
#include <gio/gio.h>
#include <optional>
#include <string>
#include <vector>

#include "plugin/feel/follow/player_choice.h"

namespace spidar::follow {

struct PlayerState {
  PlayerStatus status = PlayerStatus::kStopped;
  double rate = 1;
  std::string uri;  ///< of the film; empty if the player does not report it
  /// The object path of that film in the player; empty if the player does not report it.
  std::string track;
  bool can_pause = true, can_seek = true;
};

/// Deadline for an answer, which takes a millisecond, or some tens of them on a busy machine. A
/// player that has not answered by then is queried again.
constexpr int kAnswer_ms = 1000;

/// The name of a player for people: "vlc" for org.mpris.MediaPlayer2.vlc.instance7.
std::string short_name(const std::string& bus_name);

/// Queries the bus names of all players, or of those called `name` unless that is empty. `take`
/// gets them in the main loop, or nothing when the bus does not answer. `take` is not called once
/// `ended` is cancelled.
void list_players(GDBusConnection* bus, const std::string& name, GCancellable* ended,
                  std::function<void(std::optional<std::vector<std::string>>)> take);

/// A media player on the session bus (https://specifications.freedesktop.org/mpris-spec). No call
/// blocks, and each has a deadline. Callbacks run in the main loop; times are monotonic.
class Player {
 public:
  struct Callbacks {
    std::function<void(Player&)> state;  ///< called when a state was received
    /// Called for a player that is watched.
    std::function<void(int64_t now_ns, int64_t position_ns)> position, jump;
    std::function<void(Player&)> refusal;  ///< called when toggle() or seek() is refused
  };
  Player(GDBusConnection* bus, const std::string& bus_name, Callbacks callbacks);
  ~Player();
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;

  const std::string& bus_name() const { return bus_name_; }
  /// Returns nothing before the player has answered.
  const std::optional<PlayerState>& state() const { return state_; }
  /// Whether the player has ended, or another program has its name.
  bool is_gone() const { return is_gone_; }
  /// Sets whether the player is queried for its position.
  void watch(bool wanted);
  /// Returns false when the player has answered that it has no position.
  bool has_position() const { return has_position_; }
  void toggle();
  /// Seeks to a position at this distance from the present one.
  void seek(int64_t position_ns, int64_t distance_ns);
  /// How long a query has been waiting for its answer.
  int64_t silent_ns() const;

 private:
  static constexpr guint kPoll_ms = 20;
  /// The period of queries of the state, because some players do not report every change.
  static constexpr int64_t kAskState_ns = 1'000'000'000;

  static gboolean poll(gpointer self);
  static void on_position(GObject* bus, GAsyncResult* result, gpointer self);
  static void on_state(GObject* bus, GAsyncResult* result, gpointer self);
  static void on_signal(GDBusConnection*, const gchar*, const gchar*, const gchar*,
                        const gchar* name, GVariant* parameters, gpointer self);
  static void on_owner_changed(GDBusConnection*, const gchar*, const gchar*, const gchar*,
                               const gchar*, GVariant* parameters, gpointer self);
  static void on_order_answer(GObject* bus, GAsyncResult* result, gpointer self);
  void order(const char* method, GVariant* parameters);
  void call(const char* method, GVariant* parameters, GAsyncReadyCallback take);
  void request_position();
  void request_state();

  GDBusConnection* const bus_;
  const std::string bus_name_;
  const Callbacks callbacks_;
  GCancellable* const ended_;
  std::vector<guint> signals_;
  guint timer_ = 0;
  std::optional<PlayerState> state_;
  bool is_gone_ = false;
  bool is_watched_ = false;
  bool has_position_ = true;
  int64_t requested_ns_ = 0;  ///< when the position was queried; 0: no query waits
  int64_t state_requested_ns_ = 0;
  bool state_waits_ = false;    ///< whether a query of the state has no answer yet
  bool state_changed_ = false;  ///< whether the state has changed since the query
};

}  // namespace spidar::follow
