// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The only program of the virtual machine: sets up a Linux with a virtual USB host controller, and
/// runs the tests in it. Its root file system contains only the files that run_guest.py puts there.
#include <fcntl.h>
#include <sys/io.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <termios.h>
#include <unistd.h>

#include "spidar/session/device_factory.h"
#include "tests/support/pushed_grip.h"
#include "tests/support/test.h"

namespace {

/// Port of QEMU's isa-debug-exit, as on the command line of run_guest.py.
constexpr unsigned short kExitPort = 0xF4;

bool done(int result, const char* what) {
  if (result != 0) std::perror(what);
  return result == 0;
}

bool mount_at(const char* type, const char* path) {
  mkdir(path, 0755);
  return done(mount(type, path, type, 0, nullptr), path);
}

/// In the order of their dependencies.
bool load_modules() {
  for (const std::string name :
       {"usb-common", "usbcore", "usbip-core", "vhci-hcd", "evdev", "uinput"}) {
    const std::string path = "/modules/" + name + ".ko";
    const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    const bool loaded =
        done(static_cast<int>(syscall(SYS_finit_module, file, "", 0)), path.c_str());
    close(file);
    if (!loaded) return false;
  }
  return true;
}

bool make_linux() {
  return mount_at("proc", "/proc") && mount_at("sysfs", "/sys") && mount_at("devtmpfs", "/dev") &&
         mount_at("tmpfs", "/tmp") && load_modules();
}

/// The machine ends with the status 2 · result + 1.
[[noreturn]] void end_machine(int result) {
  std::fflush(nullptr);
  tcdrain(STDOUT_FILENO);
  if (ioperm(kExitPort, 1, 1) == 0) outb(static_cast<unsigned char>(result), kExitPort);
  _exit(result);
}

spidar::MotorVolts all_strings() {
  spidar::MotorVolts volts;
  volts.volt.fill(1);
  return volts;
}

/// Pulls until the board is lost; only a signal ends it. With `forks`, an idle child holds copies
/// of all files for the rest of the time.
[[noreturn]] void pull(const char* profile, bool forks) {
  constexpr unsigned kLonger_s = 3;
  const auto device = spidar::make_device("usb", spidar::load_profile(profile));
  device->open();
  if (forks && fork() == 0) {
    sleep(kLonger_s);
    _exit(0);
  }
  spidar::DeviceReading reading;
  while (!is_lost(device->exchange(all_strings(), reading))) {
  }
  for (;;) pause();
}

/// The same with a joystick.
[[noreturn]] void push(const char* profile) {
  const auto grip = spidar::make_grip("ff", spidar::load_profile(profile));
  grip->open();
  while (!is_lost(grip->exchange(spidar::test::told(1)))) {
  }
  for (;;) pause();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 3 && std::strcmp(argv[1], "--pull") == 0) pull(argv[2], false);
  if (argc == 3 && std::strcmp(argv[1], "--pull-and-fork") == 0) pull(argv[2], true);
  if (argc == 3 && std::strcmp(argv[1], "--push") == 0) push(argv[2]);
  if (getpid() != 1) {
    std::fputs("this is the first program of a virtual machine; see tests/kernel/run_guest.py\n",
               stderr);
    return 2;
  }
  setenv("SPIDAR_PROFILE_PATH", "/profiles", 1);
  setenv("SPIDAR_GUARDIAN", "/spidar-guardian", 1);
  setenv("GST_PLUGIN_PATH", "/plugins", 1);
  setenv("GST_PLUGIN_SYSTEM_PATH", "/plugins", 1);
  setenv("GST_REGISTRY", "/tmp/registry.bin", 1);
  setenv("GST_REGISTRY_FORK", "no", 1);
  testing::InitGoogleTest(&argc, argv);
  end_machine(make_linux() && RUN_ALL_TESTS() == 0 ? 0 : 1);
}
