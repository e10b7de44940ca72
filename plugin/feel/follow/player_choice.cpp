// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/feel/follow/player_choice.h"

#include <algorithm>
#include <iterator>
#include <tuple>

namespace spidar::follow {
namespace {

/// Of two players, the one to prefer has the greater rank.
auto rank(const PlayerView& player, bool is_followed) {
  return std::make_tuple(player.status == PlayerStatus::kPlaying, player.is_placed, is_followed);
}

bool may_be_followed(const PlayerView& player, bool is_followed, bool is_named) {
  if (player.status == PlayerStatus::kStopped) return false;
  if (!is_named && repeats_another(player.name)) return false;
  // The next film of the followed player is worth waiting for.
  return player.film == PlayerView::Film::kMoving ||
         (is_followed && player.film == PlayerView::Film::kUnknown);
}

}  // namespace

bool repeats_another(const std::string& name) {
  // Names of playerctl; of KDE Connect, for the players of a telephone; of Plasma, for those of a
  // browser; of BlueZ, for those that are connected by Bluetooth.
  constexpr const char* kNames[] = {"playerctld", "kdeconnect", "plasma-browser-integration",
                                    "mpris-proxy"};
  const std::string first = name.substr(0, name.find('.'));
  return std::find(std::begin(kNames), std::end(kNames), first) != std::end(kNames);
}

std::optional<size_t> choose_player(const std::vector<PlayerView>& players,
                                    std::optional<size_t> followed, bool is_named) {
  std::optional<size_t> best;
  for (size_t i = 0; i < players.size(); ++i) {
    if (!may_be_followed(players[i], followed == i, is_named)) continue;
    const bool is_better =
        !best || rank(players[i], followed == i) > rank(players[*best], followed == *best);
    if (is_better) best = i;
  }
  return best;
}

std::string choice_text(const PlayerView* last, const PlayerView* next, const std::string& ended) {
  std::string text;
  if (last) {
    text = last->name + " ";
    if (!ended.empty()) {
      text += ended;
    } else if (last->status == PlayerStatus::kStopped) {
      text += "has stopped";
    } else if (last->film == PlayerView::Film::kNone) {
      text += "plays no film";
    } else if (last->status == PlayerStatus::kPaused) {
      text += "is paused";
    } else {
      text += "does not tell where it is in its film";
    }
  }
  if (!next) return text + "; waits for a player that plays a film";
  if (last || next->status != PlayerStatus::kPlaying) {
    text += (last ? ", and " : "") + next->name +
            (next->status == PlayerStatus::kPlaying ? " plays: " : " is paused in a film: ");
  }
  return text + "follows " + next->name;
}

}  // namespace spidar::follow
