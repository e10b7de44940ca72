// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Common parts of the commands of spidarctl: the program, the device, the person at the terminal.
#pragma once

#include <future>
#include <memory>
#include <string>
#include <utility>

#include "spidar/device.h"
#include "spidar/grip/grip.h"
#include "spidar/link/board.h"
#include "spidar/profiles/profile.h"
#include "spidar/realtime/thread_setup.h"
#include "spidar/selftest/hold.h"
#include "spidar/session/board_list.h"
#include "spidar/tools/cli_program.h"

namespace spidar::tools {

struct Program {
  CLI::App app{"Lists, inspects, tests and calibrates SPIDARs.", "spidarctl"};
  int status = kDone;  ///< status of the command that ran
};

/// Adds a command. After parsing, `run` is called and returns the exit status; it may throw
/// UsageError, DeviceError and ProfileError. The returned object lives as long as the program.
template <typename Options>
std::pair<CLI::App&, Options&> add_command(Program& program, const char* name,
                                           const char* description, int (*run)(const Options&)) {
  const auto options = std::make_shared<Options>();
  CLI::App* const app = program.app.add_subcommand(name, description);
  app->callback([&program, options, run] { program.status = run(*options); });
  return {*app, *options};
}

void add_list(Program& program);
void add_info(Program& program);
void add_monitor(Program& program);
void add_zero(Program& program);
void add_pull(Program& program);
void add_choose(Program& program);
void add_selftest(Program& program);
void add_calibrate(Program& program);

struct DeviceOptions {
  std::string device;
  std::string profile;  ///< empty: the default profile of the board
  bool json = false, yes = false;
};

void add_device(CLI::App& app, DeviceOptions& options);
void add_json(CLI::App& app, bool& json);
/// Adds --yes, for commands that pull or push.
void add_yes(CLI::App& app, bool& yes);
/// Adds --seconds, for commands that otherwise run until they are interrupted.
void add_seconds(CLI::App& app, double& seconds);
struct OutputFile {
  std::string path;  ///< empty: none
  bool force = false;

  explicit operator bool() const noexcept { return !path.empty(); }
  /// Throws std::runtime_error if the file cannot be written, or exists and is not replaced. Call
  /// this before the device moves, so that it does not move in vain.
  void check() const;
};
/// Adds an option whose value is the file's name, and --force.
CLI::Option* add_output(CLI::App& app, const std::string& name, OutputFile& file,
                        const std::string& description);
void add_profile_file(CLI::App& app, const std::string& name, OutputFile& file,
                      const std::string& description);

/// What a command does with the motors.
enum class Motors {
  kOff,     ///< the motors stay at zero, so no profile is needed
  kZeroed,  ///< the motors are set to zero, and no named or remembered profile may prevent that
  kPulled,  ///< a real board needs a profile that somebody named
};

struct ChosenDevice {
  DeviceInfo board;
  /// Without a name if nobody has named a profile: this profile only says how many strings can be
  /// read, and allows no tension.
  Profile profile;
  // One of these is set, and not open yet.
  std::unique_ptr<StringDevice> device;  ///< a device with strings
  std::unique_ptr<Grip> grip;            ///< a device without strings

  const std::string& name() const noexcept { return device ? device->name() : grip->name(); }
};

/// Throws ProfileError and DeviceError.
ChosenDevice choose_device(const DeviceOptions& options, Motors motors,
                           boards::CountZero count_zero = boards::CountZero::kByProfile);

/// Throws DeviceError when the board has no strings; the message says that `command` needs them.
void require_strings(const DeviceInfo& board, const std::string& command);

/// Whether the device can output negative volts; other boards refuse such a profile.
bool can_reverse(const std::string& device, Profile profile);

/// From now on SIGINT, SIGTERM and SIGHUP only set interrupted(), so that the strings are released
/// before the program ends.
void catch_signals();
bool interrupted();

/// Waits until a millisecond after the last call, or not at all if that time has passed; returns
/// false when interrupted.
selftest::Pace every_millisecond();

/// Runs `work`, which moves a device, with real-time priority where permitted, because a guardian
/// allows no pause above kSilence_ms. Returns or throws what `work` does.
template <typename Work>
auto in_real_time(const Work& work) {
  std::packaged_task<decltype(work())()> task([&work] {
    request_exact_timers();
    request_real_time();
    return work();
  });
  auto result = task.get_future();
  start_thread("spidar-test", std::move(task)).join();
  return result.get();
}

/// Discards what was typed on a terminal before, which cannot answer the next question. Input from
/// a pipe stays. Call this before printing a question.
void forget_typed_ahead();

/// Returns whether the answer is yes. Throws UsageError when standard input is not a terminal.
bool confirm(const std::string& question);

/// Whether the device may be moved: the device is simulated, `yes` was given, or the answer is yes.
/// Otherwise says that nothing moved.
bool may_move(const std::string& device, bool yes, const std::string& question);

}  // namespace spidar::tools
