// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Which of several players is followed, without a session bus.
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "plugin/feel/follow/player_choice.h"

namespace spidar::test::player_choice_test {
namespace {

using follow::choice_text;
using follow::choose_player;
using follow::PlayerStatus;
using follow::PlayerView;
using Film = PlayerView::Film;

constexpr PlayerStatus kPlays = PlayerStatus::kPlaying, kPaused = PlayerStatus::kPaused,
                       kStopped = PlayerStatus::kStopped;

/// The name of the one that is chosen; empty: none.
std::string chosen(const std::vector<PlayerView>& players, const std::string& followed = "",
                   bool is_named = false) {
  std::optional<size_t> now;
  for (size_t i = 0; i < players.size(); ++i) {
    if (players[i].name == followed) now = i;
  }
  const std::optional<size_t> next = choose_player(players, now, is_named);
  return next ? players[*next].name : "";
}

TEST(PlayerChoice, OneThatPlaysAFilmIsTaken) {
  EXPECT_EQ(chosen({}), "");
  EXPECT_EQ(chosen({{"a", kStopped, Film::kMoving}}), "");
  EXPECT_EQ(chosen({{"a", kPlays, Film::kNone}, {"b", kPlays, Film::kMoving}}), "b");
  EXPECT_EQ(chosen({{"a", kPlays, Film::kUnknown}}), "");
}

TEST(PlayerChoice, APausedOneIsTakenOnlyWhileNonePlays) {
  const PlayerView paused{"paused", kPaused, Film::kMoving}, plays{"plays", kPlays, Film::kMoving};
  EXPECT_EQ(chosen({paused}), "paused");
  EXPECT_EQ(chosen({paused, plays}), "plays");
  EXPECT_EQ(chosen({paused, plays}, "paused"), "plays");
  // Music does not take the place of a film.
  EXPECT_EQ(chosen({paused, {"music", kPlays, Film::kNone}}, "paused"), "paused");
}

TEST(PlayerChoice, TheOneThatIsFollowedStaysWhileItPlays) {
  for (const std::string name : {"a", "b", "c"}) {
    EXPECT_EQ(chosen({{"a", kPlays, Film::kMoving},
                      {"b", kPlays, Film::kMoving},
                      {"c", kPlays, Film::kMoving}},
                     name),
              name);
  }
  // Its next film is being looked at.
  EXPECT_EQ(chosen({{"a", kPlays, Film::kUnknown}}, "a"), "a");
}

TEST(PlayerChoice, OneThatRepeatsAnotherIsTakenOnlyByItsName) {
  const PlayerView mpv{"mpv", kPlays, Film::kMoving};
  for (const std::string name : {"playerctld", "kdeconnect.mpris_000001"}) {
    const PlayerView repeats{name, kPlays, Film::kMoving};
    EXPECT_EQ(chosen({repeats, mpv}), "mpv");
    EXPECT_EQ(chosen({repeats}), "");
    EXPECT_EQ(chosen({repeats}, "", true), name);
  }
}

TEST(PlayerChoice, OneWithoutAPositionIsTheLastOfThoseThatPlay) {
  const PlayerView lost{"lost", kPlays, Film::kMoving, false};
  EXPECT_EQ(chosen({lost}), "lost");
  EXPECT_EQ(chosen({lost, {"b", kPlays, Film::kMoving}}, "lost"), "b");
  EXPECT_EQ(chosen({lost, {"b", kPaused, Film::kMoving}}, "lost"), "lost");
}

TEST(PlayerChoice, AChangeIsSaidInASentence) {
  const PlayerView plays{"a", kPlays, Film::kMoving}, paused{"b", kPaused, Film::kMoving};
  const PlayerView music{"c", kPlays, Film::kNone}, lost{"d", kPlays, Film::kMoving, false};
  EXPECT_EQ(choice_text(nullptr, &plays, ""), "follows a");
  EXPECT_EQ(choice_text(nullptr, &paused, ""), "b is paused in a film: follows b");
  EXPECT_EQ(choice_text(&paused, &plays, ""), "b is paused, and a plays: follows a");
  EXPECT_EQ(choice_text(&plays, &paused, "has ended"),
            "a has ended, and b is paused in a film: follows b");
  EXPECT_EQ(choice_text(&music, &plays, ""), "c plays no film, and a plays: follows a");
  EXPECT_EQ(choice_text(&lost, &plays, ""),
            "d does not tell where it is in its film, and a plays: follows a");
  EXPECT_EQ(choice_text(&plays, nullptr, "has ended"),
            "a has ended; waits for a player that plays a film");
}

}  // namespace
}  // namespace spidar::test::player_choice_test
