// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace spidar::follow {

enum class PlayerStatus { kStopped, kPaused, kPlaying };

struct PlayerView {
  enum class Film {
    kNone,     ///< no file, music, a cover, or a file that cannot be read
    kUnknown,  ///< the file is being examined
    kMoving,   ///< a file with moving pictures
  };
  std::string name;  ///< "vlc"
  PlayerStatus status = PlayerStatus::kStopped;
  Film film = Film::kNone;
  bool is_placed = true;  ///< whether the player reports its position in the film
};

/// Whether a player of this name only relays, with a delay, what another one reports.
bool repeats_another(const std::string& name);

/// Returns the index of the player to follow; nothing if there is none. Prefers playing players to
/// paused ones, then those that report their position, then `followed`, which is followed now.
/// Leaves out players that repeat another one, unless `is_named`: the user has named them.
std::optional<size_t> choose_player(const std::vector<PlayerView>& players,
                                    std::optional<size_t> followed, bool is_named);

/// Returns a sentence that says why `next` is followed and no longer `last`. `ended`, "has ended",
/// describes `last` if it is gone. Either player may be null, for none.
std::string choice_text(const PlayerView* last, const PlayerView* next, const std::string& ended);

}  // namespace spidar::follow
