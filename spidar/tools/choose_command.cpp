// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <iostream>
#include <limits>
#include <poll.h>
#include <unistd.h>

#include "spidar/selftest/encoder_signs.h"
#include "spidar/selftest/hold.h"
#include "spidar/session/device_factory.h"
#include "spidar/session/profile_choice.h"
#include "spidar/text.h"
#include "spidar/tools/device_command.h"

namespace spidar::tools {
namespace {

/// Whether a line, or the end of the file, waits on the standard input.
bool is_line_there() {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  return poll(&input, 1, 0) > 0;
}

/// Reads the counts when the person has pressed Enter. Returns false when interrupted.
bool read_when_there(selftest::StringHold& hold, const std::string& question,
                     EncoderScale::Counts& counts) {
  forget_typed_ahead();
  std::cerr << question << " and press Enter.\n";
  const bool whole =
      hold.hold_for(std::numeric_limits<double>::infinity(), [&](const auto& reading) {
        counts = reading.count;
        return !is_line_there();
      });
  std::string line;
  if (whole && !std::getline(std::cin, line)) {
    throw UsageError("the standard input ended before the grip was at every side");
  }
  return whole;
}

bool move_by_hand(ChosenDevice& chosen, selftest::HandMoves& moves) {
  moves.distance_m = selftest::hand_move_m(chosen.profile.geometry);
  selftest::StringHold hold(*chosen.device, chosen.profile, every_millisecond());
  bool whole =
      read_when_there(hold, "Pull all strings taut, hold the grip still at the centre, not turned,",
                      moves.counts[0]);
  for (size_t side = 0; whole && side < selftest::HandMoves::kSides.size(); ++side) {
    whole = read_when_there(hold,
                            std::to_string(side + 1) + " of 6: from the centre, pull the grip " +
                                as_text(1e3 * moves.distance_m) + " mm " +
                                selftest::HandMoves::kSides[side].name + ", hold it there",
                            moves.counts[side + 1]);
  }
  return whole;
}

const char* text_of(selftest::EncoderSign sign) {
  switch (sign) {
    case selftest::EncoderSign::kAsProfile:
      return "as in the profile";
    case selftest::EncoderSign::kReversed:
      return "counts the other way";
    case selftest::EncoderSign::kStill:
      return "did not count";
    case selftest::EncoderSign::kUnclear:
      return "unclear";
  }
  return "";
}

void print_others(const ChosenDevice& chosen, const selftest::HandMoves& moves) {
  std::string others;
  for (const std::string& name : fitting_profiles(chosen.board)) {
    if (selftest::encoders_agree(load_profile(name), moves)) {
      others += (others.empty() ? "" : ", ") + name;
    }
  }
  std::cout << (others.empty() ? "no profile of this board has encoders that count so"
                               : "profiles whose encoders count so: " + others)
            << '\n';
}

int choose(const DeviceOptions& options) {
  if (is_simulated(options.device)) {
    throw UsageError(options.device + ": a simulated device has its own profile");
  }
  const DeviceInfo board = board_info(options.device);
  require_strings(board, "choose");
  if (options.profile.empty()) {
    throw UsageError("choose needs --profile NAME. " + fitting_text(board));
  }
  if (!board.memory_error.empty()) throw ProfileError(board.memory_error);
  ChosenDevice chosen = choose_device(options, Motors::kOff);
  require_serial(board, options.profile);
  catch_signals();
  selftest::HandMoves moves;
  if (!move_by_hand(chosen, moves)) return kInterrupted;
  const auto signs = selftest::encoder_signs(chosen.profile, moves);
  std::cout << "  string  encoder\n";
  for (int i = 0; i < chosen.profile.geometry.count; ++i) {
    std::cout << "  " << i << "       " << text_of(signs[static_cast<size_t>(i)]) << '\n';
  }
  const bool counted = std::any_of(signs.begin(), signs.end(), [](selftest::EncoderSign sign) {
    return sign != selftest::EncoderSign::kStill;
  });
  if (!counted) {
    std::cout << "no encoder counted: check that they are connected to the board and that the "
                 "strings run over them, and move the grip as far as is asked for\n";
    return kFailed;
  }
  if (!selftest::encoders_agree(chosen.profile, moves)) {
    print_others(chosen, moves);
    return kFailed;
  }
  remember_profile(chosen.board, options.profile);
  std::cout << chosen.profile.name << " is remembered for the serial number " << chosen.board.serial
            << '\n';
  return kDone;
}

}  // namespace

void add_choose(Program& program) {
  const auto [app, options] =
      add_command(program, "choose",
                  "confirm the profile of a board by moving the grip, and remember it", choose);
  add_device(app, options);
  app.footer(
      "Confirms that the profile is that of a board, and remembers it for the board's serial\n"
      "number: the board is then driven with it wherever no profile is named. You move the grip "
      "by\n"
      "hand to six sides; the motors stay at zero. The encoders must count as the profile says.\n"
      "Measure the frame before: encoders do not tell a small frame from a large one.\n\n"
      "The profiles are remembered in $XDG_CONFIG_HOME/gst-spidar/boards.toml, by default in\n"
      "~/.config. Remove a line there to forget one.\n\n"
      "Exit status: 0 confirmed, 1 the encoders count differently, or the board has no serial\n"
      "number, or there is no device, 2 wrong usage, 130 interrupted.");
}

}  // namespace spidar::tools
