// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The bus that this program and those it starts share, from before its tests until after them.
#include "tests/emulated_bus/shared_bus.h"

#include <gst/gst.h>

namespace {

struct Prepared {
  Prepared() { gst_init(nullptr, nullptr); }
  const spidar::test::SharedBus shared;
};
const Prepared prepared;

}  // namespace
