// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// An emulated bus that this process shares with its child processes.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <unistd.h>

namespace spidar::test {

/// Create it before anything uses the bus.
class SharedBus {
 public:
  SharedBus() {
    const int file = mkstemp(path_.data());
    if (file < 0) throw std::runtime_error("no file for the emulated bus: " + path_);
    close(file);
    setenv("SPIDAR_EMULATED_BUS", path_.c_str(), 1);
  }
  ~SharedBus() {
    std::filesystem::remove(path_);
    std::filesystem::remove_all(path_ + ".input");
  }
  SharedBus(const SharedBus&) = delete;
  SharedBus& operator=(const SharedBus&) = delete;

 private:
  std::string path_ = (std::filesystem::temp_directory_path() / "spidar-bus-XXXXXX").string();
};

}  // namespace spidar::test
