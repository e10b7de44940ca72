// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <atomic>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <termios.h>
#include <unistd.h>
#include <vector>

#include "spidar/loop/haptic_loop.h"
#include "spidar/part_file.h"
#include "spidar/realtime/monotonic.h"
#include "spidar/realtime/standard_descriptors.h"
#include "spidar/session/device_factory.h"
#include "spidar/session/profile_choice.h"
#include "spidar/tools/command_line.h"
#include "spidar/tools/device_command.h"

namespace spidar::tools {
namespace {

std::atomic<bool> signalled{false};

/// Few people read English faster: most read 175 to 300 words a minute (M. Brysbaert, How many
/// words do we read per minute?, 2019).
constexpr int64_t kWord_ns = 60'000'000'000 / 300;

int64_t reading_time_ns(const std::string& text) {
  return kWord_ns * (1 + std::count(text.begin(), text.end(), ' '));
}

/// A profile with which the board can be read, but no motor can be pulled.
Profile to_read_only(const DeviceInfo& board) {
  const std::vector<std::string> fitting = fitting_profiles(board);
  if (fitting.empty()) return profile_for(board.device, "");  // throws what is wrong
  Profile profile = load_profile(fitting.front());
  profile.name.clear();
  for (StringDrive& drive : profile.drives) drive.min_tension_N = drive.max_tension_N = 0;
  return profile;
}

}  // namespace

void add_device(CLI::App& app, DeviceOptions& options) {
  app.add_option("DEVICE", options.device, "a name that spidarctl list prints")->required();
  app.add_option("--profile", options.profile, "profile of the device, a name or a file");
}

void add_json(CLI::App& app, bool& json) {
  app.add_flag("--json", json, "print JSON; names include units");
}

void add_yes(CLI::App& app, bool& yes) {
  app.add_flag("--yes", yes, "do not ask for confirmation");
}

void add_seconds(CLI::App& app, double& seconds) {
  app.add_option("--seconds", seconds, "end after this time; by default, when interrupted")
      ->check(number(0.001, 86400, " s"));
}

CLI::Option* add_output(CLI::App& app, const std::string& name, OutputFile& file,
                        const std::string& description) {
  app.add_flag("--force", file.force, "replace the file of " + name + " if it exists");
  return app.add_option(name, file.path, description);
}

void add_profile_file(CLI::App& app, const std::string& name, OutputFile& file,
                      const std::string& description) {
  const auto check = [](const std::string& text) {
    const bool good = std::filesystem::path(text).extension() == ".toml";
    return good ? std::string() : "\"" + text + "\" must end in .toml, as profile files do";
  };
  add_output(app, name, file, description)->check(CLI::Validator(check, "FILE.toml"));
}

ChosenDevice choose_device(const DeviceOptions& options, Motors motors,
                           boards::CountZero count_zero) {
  ChosenDevice chosen;
  chosen.board = board_info(options.device);
  const bool named = !options.profile.empty() || !chosen.board.profile.empty();
  if ((named && motors != Motors::kZeroed) || motors == Motors::kPulled) {
    chosen.profile = profile_for(options.device, options.profile);
  } else {
    chosen.profile = to_read_only(chosen.board);
  }
  boards::Settings settings;
  settings.count_zero = count_zero;
  // No tool is in such a hurry that it could not wait for an exchange.
  settings.threaded = false;
  if (chosen.board.has_strings) {
    chosen.device = make_device(options.device, chosen.profile, settings);
  } else {
    chosen.grip = make_grip(options.device, chosen.profile, settings);
  }
  return chosen;
}

void require_strings(const DeviceInfo& board, const std::string& command) {
  if (!board.has_strings) {
    throw DeviceError(board.device + ": " + command +
                      " is for devices with strings and encoders; this device has neither");
  }
}

bool can_reverse(const std::string& device, Profile profile) {
  profile.drives[0].motor_sign = -1;
  return can_drive(device, profile);
}

void catch_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { signalled = true; };
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal, &action, nullptr);
}

bool interrupted() {
  return signalled;
}

selftest::Pace every_millisecond() {
  return [next_ns = monotonic_now_ns()]() mutable {
    next_ns = std::max(next_ns + kTick_ns, monotonic_now_ns());
    sleep_until_ns(next_ns);
    return !interrupted();
  };
}

void forget_typed_ahead() {
  tcflush(STDIN_FILENO, TCIFLUSH);  // fails without a terminal, which does no harm
}

bool confirm(const std::string& question) {
  if (isatty(STDIN_FILENO) == 0) {
    throw UsageError(
        "there is no terminal to ask for confirmation; use --yes to continue without it");
  }
  while (true) {
    forget_typed_ahead();
    std::cerr << question << " [y/N] " << std::flush;
    const int64_t asked_ns = monotonic_now_ns();
    std::string answer;
    const bool agrees =
        std::getline(std::cin, answer) && (answer == "y" || answer == "Y" || answer == "yes");
    if (!agrees) return false;
    if (monotonic_now_ns() - asked_ns >= reading_time_ns(question)) return true;
    std::cerr << "nobody can read that so fast: read it, and answer again\n";
  }
}

bool may_move(const std::string& device, bool yes, const std::string& question) {
  if (yes || is_simulated(device) || confirm(question)) return true;
  std::cerr << "nothing was moved\n";
  return false;
}

void OutputFile::check() const {
  if (!path.empty()) PartFile(path, {force, {}});
}

}  // namespace spidar::tools

int main(int argc, char** argv) {
  using namespace spidar::tools;
  spidar::open_standard_descriptors();
  mark_files(argc, argv);
  Program program;
  program.app.set_help_flag("-h,--help", "Explain the program, or a command, and end");
  program.app.set_version_flag("--version", "spidarctl " SPIDAR_VERSION);
  program.app.require_subcommand(1);
  program.app.footer("spidarctl COMMAND --help explains a command.");
  for (const auto add : {add_list, add_info, add_monitor, add_zero, add_pull, add_choose,
                         add_selftest, add_calibrate}) {
    add(program);
  }
  return exit_status_of(program.app, [&] {
    check_command(program.app, argc, argv);
    program.app.parse(argc, argv);
    return program.status;
  });
}
