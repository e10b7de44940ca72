// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Locks by which processes exclude each other from the boards of the emulated USB.
#pragma once

namespace spidar::test {

/// Claims are locks in this file, so that they end with the last process that has inherited the
/// device file; −1: claims hold within this process only.
void set_lock_file(int file);

/// Locks the board with this address. `lock` becomes a descriptor that holds it, −1 without a lock
/// file. Not the port: a board that is plugged in is claimed by nobody, whoever still holds files
/// of the one before. False when another process has claimed the board.
bool lock_board(int address, int& lock);

/// Unlocks the board for all holders of a copy of the descriptor; −1 is ignored.
void unlock_board(int address, int& lock);

}  // namespace spidar::test
