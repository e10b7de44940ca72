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
    kUnknown,  ///< it is being looked at
    kMoving,   ///< a file with pictures
  };
  std::string name;  ///< "vlc"
  PlayerStatus status = PlayerStatus::kStopped;
  Film film = Film::kNone;
  bool is_placed = true;  ///< false: it does not tell where it is in its film
};

/// Whether a player of this name only tells what another one plays, and later than that.
bool repeats_another(const std::string& name);

/// The index of the player to follow; nothing if there is none. One that plays is taken, and a
/// paused one only while none plays; of those, `followed`, which is followed now. One that does not
/// tell where it is is taken when no other plays. Players that repeat another are left out unless
/// `is_named`: the user has named them.
std::optional<size_t> choose_player(const std::vector<PlayerView>& players,
                                    std::optional<size_t> followed, bool is_named);

/// A sentence: why `next` is followed and no longer `last`, of which `ended` says "has ended" if it
/// is gone. Each may be null, for none.
std::string say_choice(const PlayerView* last, const PlayerView* next, const std::string& ended);

}  // namespace spidar::follow
