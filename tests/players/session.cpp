// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/players/session.h"

#include <cctype>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"

namespace spidar::test {

namespace {

constexpr const char* kInSession = "SPIDAR_TEST_IN_SESSION";

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

void make_home(const std::filesystem::path& folder) {
  for (const char* name : {"home", "run"}) std::filesystem::create_directory(folder / name);
  std::filesystem::permissions(folder / "run", std::filesystem::perms::owner_all);
  setenv("HOME", (folder / "home").c_str(), 1);
  setenv("XDG_RUNTIME_DIR", (folder / "run").c_str(), 1);
  for (const char* name : {"XDG_CONFIG_HOME", "XDG_CACHE_HOME", "XDG_DATA_HOME", "XDG_STATE_HOME",
                           "DBUS_SESSION_BUS_ADDRESS", "G_DEBUG"})
    unsetenv(name);
  // Settings of its own. GNOME Web would ask whether to become the default browser, and its dialog
  // would take the keyboard.
  setenv("GSETTINGS_BACKEND", "keyfile", 1);
  const std::filesystem::path settings = folder / "home/.config/glib-2.0/settings";
  std::filesystem::create_directories(settings);
  std::ofstream(settings / "keyfile") << "[org/gnome/epiphany]\nask-for-default=false\n";
  setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
  // Reading aloud would need a bus of its own.
  setenv("NO_AT_BRIDGE", "1", 1);
  setenv("GTK_A11Y", "none", 1);
}

}  // namespace

bool is_installed(const std::string& program) {
  return run("command -v '" + program + "'").status == 0;
}

int run_in_session(int argc, char** argv, int (*inner)(int argc, char** argv)) {
  if (std::getenv(kInSession)) return inner(argc, argv);
  const TemporaryFolder folder;
  make_home(folder.path);
  setenv(kInSession, "", 1);
  if (!is_installed("dbus-run-session")) return inner(argc, argv);
  std::vector<std::string> again{"dbus-run-session", "--"};
  again.insert(again.end(), argv, argv + argc);
  return ChildProcess(again).wait();
}

bool has_session_bus() {
  return std::getenv("DBUS_SESSION_BUS_ADDRESS") != nullptr;
}

std::set<int> processes_with(const std::string& library) {
  const std::string bus = std::string("SPIDAR_EMULATED_BUS=") + std::getenv("SPIDAR_EMULATED_BUS");
  std::set<int> found;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (!std::isdigit(static_cast<unsigned char>(name[0]))) continue;
    if (content(entry.path() / "environ").find(bus) == std::string::npos) continue;
    if (content(entry.path() / "maps").find(library) != std::string::npos)
      found.insert(std::stoi(name));
  }
  return found;
}

bool press(const std::string& key) {
  // There is no window manager that would give a window the keyboard.
  return run("window=$(xdotool search --onlyvisible --name . | tail -n 1) && xdotool windowfocus "
             "\"$window\" sleep 0.2 key " +
             key)
             .status == 0;
}

}  // namespace spidar::test
