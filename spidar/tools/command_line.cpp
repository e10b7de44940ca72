// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/tools/command_line.h"

#include <cmath>
#include <cstdlib>
#include <exception>
#include <getopt.h>
#include <iostream>
#include <sstream>

#include "spidar/tools/exit_status.h"

namespace spidar {
namespace {

int run_command(const std::string& program, const std::vector<Command>& commands, const char* help,
                int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "";
  std::string known;
  for (const Command& command : commands) {
    if (name == command.name) return command.run(argc - 1, argv + 1);
    known += (known.empty() ? "" : ", ") + std::string(command.name);
  }
  if (name == "--version") {
    std::cout << program << " " SPIDAR_VERSION "\n";
    return kDone;
  }
  if (name == "--help") {
    std::cout << help;
    return kDone;
  }
  throw UsageError((name.empty() ? "no command" : name + " is not a command") + "; commands are " +
                   known);
}

}  // namespace

std::string shown(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

int run_program(const std::string& program, const std::vector<Command>& commands, const char* help,
                int argc, char** argv) {
  try {
    return run_command(program, commands, help, argc, argv);
  } catch (const UsageError& error) {
    std::cerr << program << ": " << error.what() << "; see " << program << " --help\n";
    return kWrongUsage;
  } catch (const std::exception& error) {
    std::cerr << program << ": " << error.what() << '\n';
    return kFailed;
  }
}

std::vector<std::string> parse_options(int argc, char** argv,
                                       const std::vector<CommandOption>& options) {
  std::vector<option> known;
  for (const CommandOption& one : options)
    known.push_back({one.name.c_str(), one.has_value ? required_argument : no_argument, nullptr,
                     static_cast<int>(known.size()) + 1});
  known.push_back({});
  opterr = 0;
  optind = 1;
  for (int found; (found = getopt_long(argc, argv, ":", known.data(), nullptr)) != -1;) {
    if (found == ':') throw UsageError(std::string(argv[optind - 1]) + " needs a value");
    if (found == '?' && optopt > 0 && optopt <= static_cast<int>(options.size()))
      throw UsageError(std::string(argv[optind - 1]) + ": the option takes no value");
    if (found == '?')
      throw UsageError((optopt > 0 ? "-" + std::string(1, static_cast<char>(optopt))
                                   : std::string(argv[optind - 1])) +
                       " is not an option");
    options[static_cast<size_t>(found - 1)].take(optarg ? optarg : "");
  }
  return {argv + optind, argv + argc};
}

double parse_number(const std::string& what, const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value))
    throw UsageError(what + ": \"" + text + "\" is not a number");
  return value;
}

double parse_number(const std::string& what, const std::string& text, double min, double max,
                    const std::string& unit) {
  const double value = parse_number(what, text);
  const std::string of_unit = unit.empty() ? "" : " " + unit;
  if (!(value >= min && value <= max))
    throw UsageError(what + ": " + text + of_unit + ", must be from " + shown(min) + " to " +
                     shown(max) + of_unit);
  return value;
}

std::vector<std::string> split_at_commas(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, ',');) parts.push_back(part);
  return parts;
}

std::string parse_profile_file(const std::string& what, const std::string& file) {
  const std::string ending = ".toml";
  if (file.size() <= ending.size() ||
      file.compare(file.size() - ending.size(), ending.size(), ending) != 0)
    throw UsageError(what + ": \"" + file + "\" must end in .toml, as profile files do");
  return file;
}

DeviceOptions parse_device_options(int argc, char** argv, std::vector<CommandOption> own,
                                   const std::vector<std::string>& operands) {
  DeviceOptions options;
  own.push_back({"profile", true, [&](const std::string& text) { options.profile = text; }});
  own.push_back({"help", false, [&](const std::string&) { options.help = true; }});
  std::vector<std::string> given = parse_options(argc, argv, own);
  if (options.help) return options;
  if (given.empty()) throw UsageError("no DEVICE given; 'spidarctl list' prints the devices");
  if (given.size() <= operands.size())
    throw UsageError("no " + operands[given.size() - 1] + " given");
  if (given.size() > operands.size() + 1)
    throw UsageError(given[operands.size() + 1] +
                     (operands.empty() ? ": one DEVICE only" : ": one argument too many"));
  options.device = given.front();
  options.operands.assign(given.begin() + 1, given.end());
  return options;
}

CommandOption json_option(bool& json) {
  return {"json", false, [&json](const std::string&) { json = true; }};
}

}  // namespace spidar
