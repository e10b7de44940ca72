// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A player of the session bus, by MPRIS (https://specifications.freedesktop.org/mpris-spec).
#pragma once

#include <cstdint>
#include <functional>
#include <gio/gio.h>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace spidar::follow {

struct PlayerState {
  enum class Status { kStopped, kPaused, kPlaying };
  Status status = Status::kStopped;
  double rate = 1;
  std::string uri;  ///< of what it plays; empty if it does not say
};

/// What a player is called by people: "vlc" of org.mpris.MediaPlayer2.vlc.instance7.
std::string short_name(const std::string& bus_name);

/// Bus names of the players that there are; of those called `name`, unless that is empty. Waits for
/// the bus, for a second at most.
std::vector<std::string> list_players(GDBusConnection* bus, const std::string& name);
/// Waits for the player, for 0.2 s at most; nothing if it does not answer.
std::optional<PlayerState> ask_state(GDBusConnection* bus, const std::string& bus_name);

/// Follows one. All callbacks are called in the main loop; times are of CLOCK_MONOTONIC.
class Player {
 public:
  struct Told {
    std::function<void(const PlayerState&)> state;
    std::function<void(int64_t now_ns, int64_t position_ns)> position, jump;
    std::function<void()> gone;
  };
  Player(GDBusConnection* bus, const std::string& bus_name, Told told);
  ~Player();
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;

  const std::string& bus_name() const { return bus_name_; }
  /// For how long a question has waited for its answer.
  int64_t silent_ns() const;

 private:
  static constexpr guint kPoll_ms = 20;
  /// Some players do not tell of every change.
  static constexpr int64_t kAskState_ns = 1'000'000'000;

  static gboolean poll(gpointer self);
  static void take_position(GObject* bus, GAsyncResult* result, gpointer self);
  static void take_state(GObject* bus, GAsyncResult* result, gpointer self);
  static void take_signal(GDBusConnection*, const gchar*, const gchar*, const gchar*,
                          const gchar* name, GVariant* parameters, gpointer self);
  static void take_owner(GDBusConnection*, const gchar*, const gchar*, const gchar*, const gchar*,
                         GVariant* parameters, gpointer self);
  void ask(const char* method, GVariant* parameters, GAsyncReadyCallback take);
  void ask_position();
  void ask_state_now();

  GDBusConnection* const bus_;
  const std::string bus_name_;
  const Told told_;
  GCancellable* const ended_;
  std::vector<guint> signals_;
  guint timer_ = 0;
  int64_t asked_ns_ = 0;  ///< the position; 0: no question waits
  int64_t state_asked_ns_ = 0;
};

}  // namespace spidar::follow
