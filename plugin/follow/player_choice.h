// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Which of the players a person means.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace spidar::follow {

enum class PlayerStatus { kStopped, kPaused, kPlaying };

/// What is known of a player.
struct PlayerView {
  enum class Film {
    kNone,     ///< no file, music, a cover, or what cannot be read
    kUnknown,  ///< it is being examined
    kMoving,   ///< a file with pictures
  };
  std::string name;  ///< "vlc"
  PlayerStatus status = PlayerStatus::kStopped;
  Film film = Film::kNone;
  bool is_placed = true;  ///< false: it does not report its position in the film
};

/// Whether a player of this name only repeats what another one reports, and later than that one.
bool repeats_another(const std::string& name);

/// The index of the player to follow; nothing if there is none. A player that plays comes before a
/// paused one, then one that reports its position before one that does not, then `followed`, which
/// is followed now, before others. Players that repeat another are left out unless `is_named`: the
/// user has named them.
std::optional<size_t> choose_player(const std::vector<PlayerView>& players,
                                    std::optional<size_t> followed, bool is_named);

/// A sentence that says why `next` is followed and no longer `last`; `ended`, "has ended", says so
/// of `last` if it is gone. Either player may be null, for none.
std::string say_choice(const PlayerView* last, const PlayerView* next, const std::string& ended);

}  // namespace spidar::follow
