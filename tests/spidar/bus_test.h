// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Tests with an emulated bus on which nothing is plugged in at first.
#pragma once

#include "tests/emulated_bus/bus_state.h"
#include "tests/spidar/device_test.h"

namespace spidar::test {

class BusTest : public testing::Test {
 protected:
  BusTest() { clear_bus(); }
  ~BusTest() override { clear_bus(); }
};

}  // namespace spidar::test
