// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Plugs an emulated board in for one command, or for a shell, and says what its motor outputs do:
// to rehearse what is done with a real board (docs/first-power-on.md), and what can happen to it
// (docs/when-it-goes-wrong.md). On its strings is a simulated grip in a hand.
#include <array>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include "spidar/devices/device_registry.h"
#include "spidar/profiles/profile_file.h"
#include "tests/emulated_bus/bus_state.h"
#include "tests/emulated_bus/rehearsed_grip.h"
#include "tests/emulated_bus/shared_bus.h"

namespace {

using namespace spidar;
using namespace spidar::test;
using Digits = std::array<int, 8>;
using Words = std::vector<std::string>;

constexpr const char* kUsage =
    "usage: plug_in BOARD [--profile NAME] [COMMAND [ARGUMENT]...]\n"
    "BOARD is sh4, simple or another that is on USB. Without COMMAND, a shell. The outputs of the "
    "board are printed when they have changed and stay. On the strings of the board is a grip as "
    "in the profile, which a hand holds.\n\n"
    "In that shell, and where SPIDAR_EMULATED_BUS is set as it says:\n"
    "  plug_in unplug         pull the board out\n"
    "  plug_in replug         put it back\n"
    "  plug_in restart        switch it off and on: its counters begin at zero\n"
    "  plug_in stop           press the emergency stop: the motors have no supply\n"
    "  plug_in release        release the stop\n"
    "  plug_in break STRING   break a string, from 0\n"
    "  plug_in mend           all strings are whole again\n"
    "  plug_in move X Y Z     move the grip: mm from the centre, to the right, up, near\n"
    "  plug_in move about     move and turn it in all directions, until it is moved elsewhere\n"
    "  plug_in second         plug a second board of this kind in\n"
    "  plug_in pad            plug a gamepad in, which rumbles\n"
    "  plug_in forbid         take the permission to open the board away, as without udev's rule\n"
    "  plug_in allow          give it back\n";

[[noreturn]] void refuse(const std::string& why) {
  throw std::invalid_argument(why);
}

int number(const std::string& text, int least, int most, const std::string& what) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < least || value > most) {
    refuse(what + " is a whole number from " + std::to_string(least) + " to " +
           std::to_string(most) + ", not \"" + text + "\"");
  }
  return value;
}

void require(const Words& words, size_t count, const char* right) {
  if (words.size() != count) refuse(std::string("it is: plug_in ") + right);
}

/// The rehearsal on the bus that another plug_in has begun.
Rehearsal& begun(bool needs_grip) {
  const char* const path = std::getenv("SPIDAR_EMULATED_BUS");
  if (!path || !std::filesystem::exists(path)) {
    refuse(
        "no board is plugged in: begin with plug_in sh4, and set SPIDAR_EMULATED_BUS here as it "
        "says");
  }
  Rehearsal& rehearsal = bus().rehearsal;
  if (needs_grip && rehearsal.strings == 0)
    refuse("this board has no strings, only sh4 and simple");
  return rehearsal;
}

void move(const Words& words) {
  Rehearsal& rehearsal = begun(true);
  if (words.size() == 2 && words[1] == "about") {
    rehearsal.moves_about = true;
    return;
  }
  require(words, 4, "move X Y Z, or move about");
  // Beyond the frame the grip stays at its edge.
  constexpr int kMax_mm = 1000;
  std::array<int, 3> to_mm{};
  for (size_t i = 0; i < 3; ++i) {
    to_mm[i] = number(words[i + 1], -kMax_mm, kMax_mm, "a position in mm");
  }
  for (size_t i = 0; i < 3; ++i) rehearsal.hand_um[i] = 1000 * to_mm[i];
  rehearsal.moves_about = false;
  const int mine = ++rehearsal.moves;
  // Strings that pull may keep it in motion.
  for (int rest_ms = 5000; rehearsal.arrived < mine && rest_ms > 0; --rest_ms) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

/// False when this is not such a command.
bool act(const Words& words) {
  const std::string what = words.empty() ? "" : words[0];
  if (what == "unplug" || what == "replug" || what == "restart") {
    require(words, 1, what.c_str());
    Rehearsal& rehearsal = begun(false);
    unplug(0);
    if (what == "restart") ++rehearsal.restarts;
    if (what != "unplug") plug(0, rehearsal.board.data(), "EMULATED");
  } else if (what == "stop" || what == "release") {
    require(words, 1, what.c_str());
    begun(true).stopped = what == "stop";
  } else if (what == "break") {
    require(words, 2, "break STRING");
    Rehearsal& rehearsal = begun(true);
    rehearsal.broken |= 1U << number(words[1], 0, rehearsal.strings - 1, "a string");
  } else if (what == "mend") {
    require(words, 1, "mend");
    begun(true).broken = 0;
  } else if (what == "second") {
    require(words, 1, "second");
    plug(1, begun(false).board.data(), "EMULATED2");
  } else if (what == "pad") {
    require(words, 1, "pad");
    begun(false);
    plug_evdev(0, EvdevKind::kPad);
  } else if (what == "forbid" || what == "allow") {
    require(words, 1, what.c_str());
    begun(false);
    bus().port[0].forbidden = what == "forbid";
  } else if (what == "move") {
    move(words);
  } else {
    return false;
  }
  return true;
}

Digits outputs(const UsbPort& port) {
  Digits digits{};
  for (size_t i = 0; i < digits.size(); ++i) digits[i] = port.digit[i];
  return digits;
}

void print(const Digits& digits) {
  std::fprintf(stderr, "outputs of the board, digits:");
  for (const int digit : digits) std::fprintf(stderr, " %4d", digit);
  std::fprintf(stderr, "\n");
}

/// Null for a board without strings. An empty name is the profile of the board's simulation.
std::unique_ptr<RehearsedGrip> grip_on(const std::string& profile_name) {
  const std::string board = bus().rehearsal.board.data();
  for (const DeviceKind& kind : usb_kinds()) {
    if (kind.board != board || *kind.profile_board == 0) continue;
    const Profile profile = load_profile(profile_name.empty() ? kind.profile : profile_name);
    bus().rehearsal.strings = profile.geometry.count;
    return std::make_unique<RehearsedGrip>(profile, kind.traits.dac(profile));
  }
  if (!profile_name.empty()) refuse(board + " has no strings, and therefore no profile");
  return nullptr;
}

/// Plugins of GStreamer that use more of udev than the emulated bus has crash on it while they are
/// looked at. That happens once, here.
void let_gstreamer_look() {
  if (std::system("gst-inspect-1.0 --exists identity >/dev/null 2>&1") == -1) {
    std::fprintf(stderr, "plug_in: sh: %s\n", std::strerror(errno));
  }
}

pid_t start(const Words& command) {
  const pid_t child = fork();
  if (child != 0) return child;
  const std::string own = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const char* const path = std::getenv("PATH");
  setenv("PATH", (own + ":" + (path ? path : "/usr/bin:/bin")).c_str(), 1);
  setenv("LD_PRELOAD", EMULATED_BUS_LIBRARY, 1);
  setenv("SPIDAR_GUARDIAN", EMULATED_GUARDIAN, 1);
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  execvp(arguments[0], arguments.data());
  std::fprintf(stderr, "plug_in: %s: %s\n", arguments[0], std::strerror(errno));
  _exit(127);
}

/// Returns the exit status.
int plug_in_for(Words words) {
  const SharedBus shared;
  const std::string board = words.empty() ? "" : words[0];
  UsbPort& port = plug(0, board, "EMULATED");
  board.copy(bus().rehearsal.board.data(), bus().rehearsal.board.size() - 1);
  words.erase(words.begin());
  std::string profile_name;
  if (!words.empty() && words[0] == "--profile") {
    if (words.size() < 2) refuse("--profile needs a name");
    profile_name = words[1];
    words.erase(words.begin(), words.begin() + 2);
  }
  const std::unique_ptr<RehearsedGrip> grip = grip_on(profile_name);
  if (words.empty()) {
    const char* const shell = std::getenv("SHELL");
    words = {shell ? shell : "/bin/sh"};
  }
  std::fprintf(stderr,
               "for \"plug_in stop\" and the like in another terminal: export "
               "SPIDAR_EMULATED_BUS=%s\n",
               std::getenv("SPIDAR_EMULATED_BUS"));
  let_gstreamer_look();
  const pid_t child = start(words);
  // Of a ramp only the end: what has not changed for a hundredth of a second.
  constexpr int kStays = 10;
  // Milliseconds more in which the guardian has to act.
  constexpr int kRest = 100;
  Digits shown{}, last{};
  int status = 0, same = 0;
  bool ended = false;
  for (int rest = kRest; rest > 0; rest -= ended) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (grip) grip->follow(port, bus().rehearsal);
    const Digits now = outputs(port);
    same = now == last ? same + 1 : 0;
    if (same >= kStays && now != shown) print(shown = now);
    last = now;
    ended = ended || waitpid(child, &status, WNOHANG) == child;
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

int main(int argc, char** argv) {
  const Words words(argv + 1, argv + argc);
  try {
    return act(words) ? 0 : plug_in_for(words);
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "plug_in: %s\n%s", error.what(), kUsage);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "plug_in: %s\n", error.what());
  }
  return 2;
}
