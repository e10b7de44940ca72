// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What an application can set of how motion and force are shown.
#pragma once

namespace spidar {

struct DisplayProperties {
  bool overlay = false;
  double arrow_scale = 4;
  bool debug_window = false;
  bool attach_meta = false;
};

}  // namespace spidar
