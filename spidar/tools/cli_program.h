// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Common parts of the programs that are called as PROGRAM COMMAND ARGUMENTS.
#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <functional>
#include <iostream>
#include <string>

#include "spidar/text.h"
#include "spidar/tools/command_line.h"

namespace spidar::tools {

/// Accepts finite numbers in a range; CLI::Range accepts NaN, too. `unit` is for the message: " s".
inline CLI::Validator number(double least, double most, const std::string& unit = "") {
  const std::string range = "a number from " + as_text(least) + " to " + as_text(most) + unit;
  const auto check = [least, most, range](const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const bool good = !text.empty() && *end == '\0' && value >= least && value <= most;
    return good ? std::string() : "\"" + text + "\" is not " + range;
  };
  return {check, ""};
}

/// Throws UsageError when argv[1] is not one of the program's commands. CLI11 says only that a
/// command is required.
inline void check_command(const CLI::App& program, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  std::string known;
  for (const CLI::App* command : program.get_subcommands({})) {
    if (command->get_name() == argv[1]) return;
    known += (known.empty() ? "" : ", ") + command->get_name();
  }
  throw UsageError(std::string(argv[1]) + " is not a command; commands are " + known);
}

/// The command line of the help that explains the error.
inline std::string help_of(const CLI::App& program) {
  std::string command = program.get_name();
  for (const CLI::App* given : program.get_subcommands()) command += ' ' + given->get_name();
  return command + " --help";
}

/// Returns the exit status of `run`, which parses the command line and may throw. Prints the help,
/// the version or the error.
inline int exit_status_of(const CLI::App& program, const std::function<int()>& run) {
  const std::string& name = program.get_name();
  try {
    return status_after_printing(name, run());
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return status_after_printing(name, program.exit(error));
    std::cerr << name << ": " << error.what() << "; see " << help_of(program) << '\n';
    return kWrongUsage;
  } catch (const UsageError& error) {
    std::cerr << name << ": " << error.what() << "; see " << help_of(program) << '\n';
    return kWrongUsage;
  } catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << '\n';
    return kFailed;
  }
}

}  // namespace spidar::tools
