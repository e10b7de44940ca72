// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/feel/follow/follow.h"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <unistd.h>
#include <utility>

#include <glib-unix.h>

#include "plugin/feel/follow/felt_element.h"
#include "plugin/feel/follow/film_plan.h"
#include "plugin/feel/follow/film_thread.h"
#include "plugin/feel/follow/mpris_player.h"
#include "plugin/feel/follow/player_choice.h"
#include "plugin/feel/follow/position_filter.h"
#include "plugin/gobject/ref.h"
#include "spidar/realtime/monotonic.h"
#include "spidar/text.h"

namespace spidar::follow {
namespace {

/// Every function runs in the main loop, and only end() waits.
class Follower {
 public:
  Follower(GDBusConnection* bus, std::string name, std::vector<std::string> properties)
      : bus_(bus),
        name_(std::move(name)),
        thread_(std::make_unique<FilmThread>(std::move(properties))) {
    timer_ = g_timeout_add(kTick_ms, tick, this);
  }
  /// Call end() first.
  ~Follower() {
    g_cancellable_cancel(ended_.get());
    g_source_remove(timer_);
  }
  Follower(const Follower&) = delete;
  Follower& operator=(const Follower&) = delete;

  /// Returns false when a file, a network or a device delays the end for longer than kEnd. The
  /// process must then exit without cleaning up; its guardian sets the motors to zero.
  bool end() {
    stopped_ = true;
    const int64_t until_ns = monotonic_now_ns() + std::chrono::nanoseconds(kEnd).count();
    if (!thread_->end(kEnd)) return false;
    while (planning_ > 0 && monotonic_now_ns() < until_ns) {
      g_main_context_iteration(nullptr, TRUE);  // the timer continues
    }
    return planning_ == 0;
  }

 private:
  /// As often as the loop receives the playback clock.
  static constexpr guint kTick_ms = 10;
  static constexpr int64_t kSearch_ns = 250'000'000;
  /// A player that reports the same position for this long is stalled: it loads, or is stopped. VLC
  /// reports a position every 0.37 s.
  static constexpr int64_t kStandstill_ns = 1'000'000'000;
  /// After this time, a standstill is reported.
  static constexpr int64_t kLost_ns = 3'000'000'000;
  /// The force rests after this time without an answer, which takes at most tens of milliseconds.
  static constexpr int64_t kNoAnswer_ns = 300'000'000;
  /// For this time, no paused player is followed, because others have yet to report that they play.
  static constexpr int64_t kSettle_ns = 1'000'000'000;
  static constexpr int kMaxPlans = 8;          ///< films that are examined at the same time
  static constexpr size_t kMaxPrinted = 1000;  ///< sentences that are remembered
  static constexpr const char* kRefuses =
      " does not let other programs control it: pause it, and seek, in its own window";
  /// How long reading files and closing devices may take at the end.
  static constexpr std::chrono::milliseconds kEnd{2000};

  static gboolean tick(gpointer user) {
    auto& self = *static_cast<Follower*>(user);
    if (self.stopped_) return G_SOURCE_CONTINUE;
    const int64_t now_ns = monotonic_now_ns();
    if (now_ns - self.searched_ns_ >= kSearch_ns && !self.is_searching_) self.search(now_ns);
    self.forget_gone();
    self.judge_position(now_ns);
    self.choose(now_ns);
    self.update_goal(now_ns);
    self.carry_out(self.thread_->take_request());
    return G_SOURCE_CONTINUE;
  }

  // --- players ----------------------------------------------------------------------------------

  void search(int64_t now_ns) {
    searched_ns_ = now_ns;
    is_searching_ = true;
    list_players(bus_, name_, ended_.get(),
                 [this](const std::optional<std::vector<std::string>>& found) {
                   is_searching_ = false;
                   if (!found) return print_once("the session bus does not answer");
                   has_searched_ = true;
                   for (const std::string& each : *found) add(each);
                 });
  }

  void add(const std::string& bus_name) {
    std::unique_ptr<Player>& player = players_[bus_name];
    if (player) return;
    player = std::make_unique<Player>(
        bus_, bus_name,
        Player::Callbacks{
            [this](Player& changed) { update_state(changed); },
            [this](int64_t now_ns, int64_t position_ns) {
              filter_.add(now_ns, position_ns);
              has_moved_ = has_moved_ || (!is_beginning_ && position_ns > position_ns_);
              add_position(now_ns, position_ns);
            },
            [this](int64_t now_ns, int64_t position_ns) {
              filter_.add_jump(now_ns, position_ns);
              add_position(now_ns, position_ns);
            },
            [this](Player& refusing) { print_once(short_name(refusing.bus_name()) + kRefuses); }});
  }

  /// Destroys the players that are gone, which their own callbacks must not do.
  void forget_gone() {
    for (auto i = players_.begin(); i != players_.end();) {
      if (!i->second->is_gone()) {
        ++i;
        continue;
      }
      if (i->second.get() == player_) {
        gone_ = PlayerView();
        gone_->name = short_name(i->first);
        follow(nullptr);
      }
      i = players_.erase(i);
    }
  }

  void update_state(Player& player) {
    if (&player != player_) return;
    const PlayerState state = *player.state();
    const bool plays = state.status == PlayerStatus::kPlaying;
    if (plays && filter_.has_begun() && state.rate != state_.rate) {
      filter_.change_rate(monotonic_now_ns(), state.rate);
    }
    const bool begins = plays && state_.status != state.status;
    if (state.uri != state_.uri) has_moved_ = false;
    if (begins || (plays && state.uri != state_.uri)) begin();
    if (!plays) {
      is_beginning_ = false;
      filter_ = PositionFilter();
    }
    state_ = state;
  }

  /// Begins a playback: the next reported position resets the filter.
  void begin() {
    is_beginning_ = is_placed_ = true;
    began_ns_ = monotonic_now_ns();
    filter_ = PositionFilter();
  }

  void add_position(int64_t now_ns, int64_t position_ns) {
    position_ns_ = position_ns;
    if (std::exchange(is_beginning_, false)) filter_.reset(now_ns, position_ns, state_.rate);
  }

  // --- films ------------------------------------------------------------------------------------

  /// Returns the plan of an address: null while the address is being examined.
  std::shared_ptr<const FilmPlan> plan_of(const std::string& address) {
    // A player may name another film before a slow disk has shown this one.
    if (planning_ >= kMaxPlans && plans_.count(address) == 0) return nullptr;
    const auto [found, is_new] = plans_.emplace(address, nullptr);
    if (is_new) start_planning(address);
    return found->second;
  }

  void start_planning(const std::string& address) {
    ++planning_;
    struct PlanTask {
      std::string address;
      const std::atomic<bool>* stopped;
      FilmPlan plan;
    };
    const auto run = [](GTask* task, gpointer, gpointer data, GCancellable*) {
      auto& asked = *static_cast<PlanTask*>(data);
      asked.plan = plan_film(asked.address, asked.stopped);
      g_task_return_boolean(task, TRUE);
    };
    const auto finished = [](GObject*, GAsyncResult* result, gpointer user) {
      auto& self = *static_cast<Follower*>(user);
      auto& found = *static_cast<PlanTask*>(g_task_get_task_data(G_TASK(result)));
      --self.planning_;
      const auto plan = self.plans_.find(found.address);
      if (plan == self.plans_.end()) return;
      plan->second = std::make_shared<const FilmPlan>(std::move(found.plan));
    };
    GTask* const task = g_task_new(nullptr, nullptr, finished, this);
    g_task_set_task_data(task, new PlanTask{address, &stopped_, {}},
                         [](gpointer data) { delete static_cast<PlanTask*>(data); });
    g_task_run_in_thread(task, run);
    g_object_unref(task);
  }

  // --- the choice -------------------------------------------------------------------------------

  PlayerView view_of(const std::string& bus_name, const Player& player) {
    PlayerView view;
    view.name = short_name(bus_name);
    if (!player.state()) return view;
    view.status = player.state()->status;
    view.is_placed = &player != player_ || is_placed_;
    const std::string& uri = player.state()->uri;
    if (view.status == PlayerStatus::kStopped || uri.empty()) return view;
    // Only a named player may play what is not a file: browsers report pages.
    if (name_.empty() && path_of(uri).empty()) return view;
    used_.insert(uri);
    const auto plan = plan_of(uri);
    if (!plan) {
      view.film = PlayerView::Film::kUnknown;
    } else if (plan->refused.empty()) {
      view.film = PlayerView::Film::kMoving;
    }
    return view;
  }

  void choose(int64_t now_ns) {
    if (!has_searched_) return;
    if (began_to_choose_ns_ == 0) began_to_choose_ns_ = now_ns;
    std::vector<PlayerView> views;
    std::vector<Player*> players;
    std::optional<size_t> followed;
    bool is_settled = true;
    used_.clear();
    for (const auto& [bus_name, player] : players_) {
      if (player.get() == player_) followed = players.size();
      players.push_back(player.get());
      views.push_back(view_of(bus_name, *player));
      is_settled = is_settled && player->state() && views.back().film != PlayerView::Film::kUnknown;
    }
    forget_films();
    const std::optional<size_t> next = choose_player(views, followed, !name_.empty());
    const bool is_paused = next && views[*next].status != PlayerStatus::kPlaying;
    is_settled = is_settled || now_ns - began_to_choose_ns_ > kSettle_ns;
    const bool is_changed = next != followed || gone_;
    if (is_changed && (is_settled || (next && !is_paused))) {
      const PlayerView* const last = gone_ ? &*gone_ : followed ? &views[*followed] : nullptr;
      print_message(choice_text(last, next ? &views[*next] : nullptr, gone_ ? "has ended" : ""));
      has_said_that_it_waits_ = true;
      gone_.reset();
      follow(next ? players[*next] : nullptr);
    }
    if (!player_ && is_settled) print_why_none(views, players);
  }

  /// Forgets films that no player plays any more, so that a changed file is examined again.
  void forget_films() {
    for (auto i = plans_.begin(); i != plans_.end();) {
      i = i->second && used_.count(i->first) == 0 ? plans_.erase(i) : std::next(i);
    }
  }

  void follow(Player* next) {
    if (player_) player_->watch(false);
    player_ = next;
    state_ = {};
    position_ns_ = 0;
    is_beginning_ = has_moved_ = false;
    is_placed_ = true;
    filter_ = PositionFilter();
    if (!player_) return;
    player_->watch(true);
    update_state(*player_);
  }

  // --- messages ---------------------------------------------------------------------------------

  void print_once(const std::string& text) {
    if (printed_.size() >= kMaxPrinted) printed_.clear();
    if (printed_.insert(text).second) print_message(text);
  }

  void print_why_none(const std::vector<PlayerView>& views, const std::vector<Player*>& players) {
    for (size_t i = 0; i < views.size(); ++i) {
      if (views[i].status != PlayerStatus::kPlaying) continue;
      if (repeats_another(views[i].name) && name_.empty()) continue;
      const std::string& uri = players[i]->state()->uri;
      if (uri.empty()) {
        print_once(views[i].name + " does not say which file it plays");
        continue;
      }
      const auto plan = plans_.find(uri);
      if (plan == plans_.end()) {
        const bool is_web = g_str_has_prefix(uri.c_str(), "http");
        print_once(views[i].name + " plays " + uri + ", which is no file of this machine" +
                   (is_web ? "; it is followed with spidar-feel --follow " + views[i].name : ""));
      } else if (plan->second) {
        print_once(views[i].name + " plays " + plan->second->name + ": " + plan->second->refused +
                   "; without force until the next film");
      }
    }
    if (std::exchange(has_said_that_it_waits_, true)) return;
    print_message(
        name_.empty()
            ? "waits for a player that plays a file: VLC, or mpv with the package mpv-mpris"
            : "waits for a player that is called " + name_ +
                  " in MPRIS and plays a film; mpv needs the package mpv-mpris");
  }

  /// Prints that the player does not report its position, or why it is not felt.
  void judge_position(int64_t now_ns) {
    if (!player_ || state_.status != PlayerStatus::kPlaying) return;
    const std::string name = short_name(player_->bus_name());
    constexpr const char* kHelp =
        ", so nothing of it is felt; VLC and mpv tell it, and spidar-feel FILM plays by itself";
    const int64_t moved_ns = std::max(filter_.newest_ns(), began_ns_);
    if (filter_.runs_backwards()) {
      print_once(name + " plays backwards, which is not felt: play it forwards");
      is_placed_ = false;
    } else if (!player_->has_position()) {
      print_once(name + " does not tell where it is in its film" + kHelp);
      is_placed_ = false;
    } else if (now_ns - moved_ns > kLost_ns) {
      print_once(name +
                 formatted(" says that it plays, and that it stands at %.1f s",
                           1e-9 * static_cast<double>(position_ns_)) +
                 kHelp);
      is_placed_ = false;
    } else if (!is_placed_ && filter_.newest_ns() > began_ns_) {
      is_placed_ = true;
    }
  }

  // --- the goal ---------------------------------------------------------------------------------

  void update_goal(int64_t now_ns) {
    FilmGoal goal;
    if (player_ && state_.status != PlayerStatus::kStopped) {
      const auto plan = plans_.find(state_.uri);
      if (plan != plans_.end() && plan->second && plan->second->refused.empty()) {
        goal.plan = plan->second;
      }
    }
    if (goal.plan) {
      if (!goal.plan->remark.empty()) print_once(goal.plan->remark);
      const bool stands = now_ns - std::max(filter_.newest_ns(), began_ns_) > kStandstill_ns ||
                          player_->silent_ns() > kNoAnswer_ns || filter_.runs_backwards();
      const bool plays = state_.status == PlayerStatus::kPlaying;
      goal.plays = plays && has_moved_ && !stands;
      goal.rate = state_.rate;
      goal.at_ns = now_ns;
      if (!goal.plays) goal.position_ns = position_ns_;
      if (goal.plays && filter_.has_begun()) {
        goal.position_ns = filter_.position_at(now_ns) - lead_ns(*goal.plan);
      }
    }
    thread_->set_goal(std::move(goal));
  }

  /// Controls the player that is followed.
  void carry_out(const FilmRequest& request) {
    if (!player_ || !player_->state()) return;
    const bool plays = state_.status == PlayerStatus::kPlaying;
    const bool toggles = request.plays && *request.plays != plays;
    if ((toggles && !state_.can_pause) || (request.position_ns && !state_.can_seek)) {
      return print_once(short_name(player_->bus_name()) + kRefuses);
    }
    if (request.position_ns) {
      player_->seek(*request.position_ns, *request.position_ns - position_ns_);
    }
    if (toggles) player_->toggle();
  }

  /// How far reported positions are ahead: mpv reports that of the picture that it shows next.
  int64_t lead_ns(const FilmPlan& plan) const {
    return short_name(player_->bus_name()) == "mpv" ? plan.frame_ns : 0;
  }

  GDBusConnection* const bus_;
  const std::string name_;
  const Ref<GCancellable> ended_{g_cancellable_new()};
  guint timer_ = 0;
  std::atomic<bool> stopped_{false};
  int64_t searched_ns_ = 0;
  bool is_searching_ = false, has_searched_ = false;
  int64_t began_to_choose_ns_ = 0;
  std::map<std::string, std::unique_ptr<Player>> players_;  ///< by their bus names
  std::map<std::string, std::shared_ptr<const FilmPlan>> plans_;
  std::set<std::string> used_;  ///< the addresses that players play
  int planning_ = 0;            ///< number of files that are being examined
  std::set<std::string> printed_;
  bool has_said_that_it_waits_ = false;
  Player* player_ = nullptr;
  std::optional<PlayerView> gone_;  ///< the followed player that has gone, until its end is printed
  PlayerState state_;
  int64_t position_ns_ = 0;    ///< the newest reported position
  bool is_beginning_ = false;  ///< the next position begins a playback
  bool has_moved_ = false;     ///< the film has moved forwards
  bool is_placed_ = true;      ///< the player reports its position
  int64_t began_ns_ = 0;       ///< when playback began
  PositionFilter filter_;
  std::unique_ptr<FilmThread> thread_;
};

gboolean quit(gpointer loop) {
  g_main_loop_quit(static_cast<GMainLoop*>(loop));
  return G_SOURCE_CONTINUE;
}

void lose_bus(GDBusConnection*, gboolean, GError*, gpointer loop) {
  print_message("the session bus has ended");
  quit(loop);
}

/// Returns null, with the reason in `error`, after kLimit_ms or when `loop` quits.
Ref<GDBusConnection> connect(GMainLoop* loop, std::string& error) {
  struct Call {
    GMainLoop* loop;
    Ref<GDBusConnection> bus;
    std::string error;
    bool is_waited_for = true;
  };
  // The answer may come after this function has returned.
  auto* const call = new std::shared_ptr<Call>(new Call{loop, nullptr, "", true});
  const std::shared_ptr<Call> kept = *call;
  const auto take = [](GObject*, GAsyncResult* result, gpointer user) {
    const std::unique_ptr<std::shared_ptr<Call>> own(static_cast<std::shared_ptr<Call>*>(user));
    Call& answered = **own;
    g_autoptr(GError) failed = nullptr;
    answered.bus.reset(g_bus_get_finish(result, &failed));
    if (failed) answered.error = failed->message;
    if (answered.is_waited_for) g_main_loop_quit(answered.loop);
  };
  constexpr guint kLimit_ms = 5 * kAnswer_ms;  // a bus that this call starts needs longer
  kept->error = "it does not answer";
  const guint timer = g_timeout_add(kLimit_ms, quit, loop);
  g_bus_get(G_BUS_TYPE_SESSION, nullptr, take, call);
  g_main_loop_run(loop);
  g_source_remove(timer);
  kept->is_waited_for = false;
  error = kept->error;
  return std::move(kept->bus);
}

}  // namespace

int run(const std::string& name, const std::vector<std::string>& properties) {
  GMainLoop* const loop = g_main_loop_new(nullptr, FALSE);
  static bool is_interrupted = false;
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    g_unix_signal_add(
        number,
        [](gpointer user) {
          is_interrupted = true;
          return quit(user);
        },
        loop);
  }
  std::string error;
  const Ref<GDBusConnection> bus = connect(loop, error);
  bool has_ended = bus != nullptr;
  if (bus) {
    g_dbus_connection_set_exit_on_close(bus.get(), FALSE);
    g_signal_connect(bus.get(), "closed", G_CALLBACK(lose_bus), loop);
    Follower* const follower = new Follower(bus.get(), name, properties);
    if (!is_interrupted) g_main_loop_run(loop);
    has_ended = follower->end();
    if (has_ended) delete follower;
  } else if (!is_interrupted) {
    print_message("there is no session bus, by which players are followed: " + error);
  }
  // Threads that have not ended in time still run.
  if (!has_ended) {
    std::fflush(nullptr);
    _exit(bus || is_interrupted ? 0 : 1);
  }
  g_main_loop_unref(loop);
  return 0;
}

}  // namespace spidar::follow
