// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Fuzz target of what a player and its window say to each other; tests/README.md says how to run it
// under libFuzzer. The first byte says who speaks, the rest is the message. Nothing may be read
// beyond its end, and an accepted message must be accepted again after it is written.
#include <cstddef>
#include <cstdint>
#include <vector>

#include "numbers.h"
#include "plugin/window/view/messages.h"

using namespace spidar;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  const std::vector<uint8_t> bytes(data + 1, data + size);
  if (data[0] % 2 == 0) {
    const auto message = window::to_window(bytes);
    if (message)
      require(window::to_window(window::to_bytes(*message)).has_value(),
              "fuzz_window: refused again");
  } else if (const auto message = window::from_window(bytes)) {
    require(window::to_bytes(*message) == bytes,
            "fuzz_window: a message from the window is another");
  }
  return 0;
}
