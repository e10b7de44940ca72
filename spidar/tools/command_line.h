// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What the commands' command lines have in common.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace spidar {

/// A command line that cannot be followed. what() says what was wrong and what would be right.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct CommandOption {
  std::string name;  ///< without the dashes
  bool has_value = false;
  std::function<void(const std::string& value)> take;
};

/// Calls take() of the options that are given, in any place, and returns the other arguments.
/// `argv[0]` is the sub-command. Throws UsageError, and what take() throws.
std::vector<std::string> parse_options(int argc, char** argv,
                                       const std::vector<CommandOption>& options);

/// Throws UsageError that begins with `what` when `text` is no finite number.
double parse_number(const std::string& what, const std::string& text);

/// Throws UsageError also when it is not from `min` to `max`. `unit` is for the message: "s".
double parse_number(const std::string& what, const std::string& text, double min, double max,
                    const std::string& unit);

/// Parts between commas.
std::vector<std::string> split_at_commas(const std::string& text);

/// Throws UsageError when `file` does not end in .toml, as profile files do.
std::string parse_profile_file(const std::string& what, const std::string& file);

/// What every command that opens a device is told.
struct DeviceOptions {
  std::string device;
  std::string profile;  ///< empty: the one that the board begins with
  bool help = false;
  std::vector<std::string> operands;  ///< after DEVICE
};

/// DEVICE and as many operands as `operands` names, --profile, --help, and `own` options.
/// `help` in the result: nothing else is to be done. Throws UsageError.
DeviceOptions parse_device_options(int argc, char** argv, std::vector<CommandOption> own = {},
                                   const std::vector<std::string>& operands = {});

/// One thing that a program can do. run() takes the command line from the command's name on and
/// returns the exit status; it may throw.
struct Command {
  const char* name;
  int (*run)(int argc, char** argv);
};

/// The main() of a program that is called as PROGRAM COMMAND ARGUMENTS…: runs the command, answers
/// --help with `help` and --version, and prints what a command throws to standard error. Returns
/// the exit status (see exit_status.h).
int run_program(const std::string& program, const std::vector<Command>& commands, const char* help,
                int argc, char** argv);

/// --json for `options` of commands that give data. Outlived by `json`.
CommandOption json_option(bool& json);

}  // namespace spidar
