// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Between spidar-feel and the player that it becomes: whether the player shows video by GStreamer.
/// A player that does not, such as mpv, would otherwise play and end without a word about the
/// force.
#pragma once

#include <string>

namespace spidar {

/// Starts a process that prints a message on standard error unless this process, which becomes the
/// player, or one that it starts calls notice_video() within `kPatience_s`. It prints the message
/// at once when all of them have ended. Does nothing when such a process waits already. Call it
/// before any thread is started.
void expect_video(const std::string& program);

/// Called when a video begins to play. Only the first call in a process does anything.
void notice_video() noexcept;

/// Long enough for a player to start and open its film on a slow machine.
constexpr int kPatience_s = 5;

}  // namespace spidar
