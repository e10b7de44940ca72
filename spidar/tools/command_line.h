// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Command-line parsing shared by all commands.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace spidar {

/// An invalid command line. what() says what was wrong and what would be right.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct CommandOption {
  std::string name;  ///< without the dashes
  bool has_value = false;
  std::function<void(const std::string& value)> take;
};

/// Calls take() for each option that is given, at any position, and returns the other arguments.
/// `argv[0]` is the name of the sub-command. Throws UsageError, and what take() throws.
std::vector<std::string> parse_options(int argc, char** argv,
                                       const std::vector<CommandOption>& options);

/// Throws UsageError that begins with `what` when `text` is not a finite number.
double parse_number(const std::string& what, const std::string& text);

/// Also throws UsageError when the number is not in `min` … `max`. `unit` is for the message: "s".
double parse_number(const std::string& what, const std::string& text, double min, double max,
                    const std::string& unit);

/// Splits at commas.
std::vector<std::string> split_at_commas(const std::string& text);

/// Throws UsageError when `file` does not end in .toml, as profile files do.
std::string parse_profile_file(const std::string& what, const std::string& file);

/// A number as a person writes it: with up to six digits, without zeros at the end.
std::string shown(double value);

/// Arguments of every command that opens a device.
struct DeviceOptions {
  std::string device;
  std::string profile;  ///< empty: the default profile of the board
  bool help = false;
  std::vector<std::string> operands;  ///< after DEVICE
};

/// Parses DEVICE, as many operands as `operands` names, --profile, --help, and the options `own`.
/// If `help` is set in the result, there is nothing else to do. Throws UsageError.
DeviceOptions parse_device_options(int argc, char** argv, std::vector<CommandOption> own = {},
                                   const std::vector<std::string>& operands = {});

/// One command of a program. run() takes the command line from the command's name on and returns
/// the exit status; it may throw.
struct Command {
  const char* name;
  int (*run)(int argc, char** argv);
};

/// main() of a program that is called as PROGRAM COMMAND ARGUMENTS…: runs the command, handles
/// --version and --help (with `help`), and prints exceptions of a command to standard error.
/// Returns the exit status (see exit_status.h).
int run_program(const std::string& program, const std::vector<Command>& commands, const char* help,
                int argc, char** argv);

/// The option --json of commands that print data. `json` must outlive the result.
CommandOption json_option(bool& json);

}  // namespace spidar
