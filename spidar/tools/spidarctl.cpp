// Looks after SPIDARs: what there is, and where their encoders are zero.

#include <cstring>
#include <exception>
#include <iostream>
#include <string>

#include "spidar/profile.h"
#include "spidar/tools/calibrate_command.h"
#include "spidar/tools/calibrate_options.h"

namespace {

using namespace spidar;

constexpr int kFailed = 1, kWrongUsage = 2;

constexpr const char* kHelp = R"(usage: spidarctl COMMAND

  list        devices and profiles that there are
  calibrate   find the string lengths at which the encoders are zero;
              see spidarctl calibrate --help
  --help
  --version
)";

int list_command(int argc, char** argv) {
  if (argc > 1) throw UsageError(std::string(argv[1]) + ": list takes no arguments");
  std::cout << "devices\n  sim  simulated, made of its profile and equations\n\nprofiles\n";
  for (const std::string& name : list_profiles()) {
    std::cout << "  " << name << "  ";
    try {
      std::cout << load_profile(name).description << '\n';
    } catch (const ProfileError& error) {
      std::cout << "cannot be used: " << error.what() << '\n';
    }
  }
  return 0;
}

int run(int argc, char** argv) {
  const std::string command = argc > 1 ? argv[1] : "";
  if (command == "list") return list_command(argc - 1, argv + 1);
  if (command == "calibrate") return calibrate_command(argc - 1, argv + 1);
  if (command == "--version") {
    std::cout << "spidarctl " SPIDAR_VERSION "\n";
    return 0;
  }
  if (command == "--help") {
    std::cout << kHelp;
    return 0;
  }
  throw UsageError((command.empty() ? "no command" : command + " is not a command") +
                   std::string("; commands are list, calibrate"));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const UsageError& error) {
    std::cerr << "spidarctl: " << error.what() << "; see spidarctl --help\n";
    return kWrongUsage;
  } catch (const std::exception& error) {
    std::cerr << "spidarctl: " << error.what() << '\n';
    return kFailed;
  }
}
