// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Memory of a frame that counts how it is accessed.
#pragma once

#include <gst/gst.h>

namespace spidar::test {

struct MemoryUse {
  int reads = 0;   ///< maps for reading only
  int writes = 0;  ///< maps for writing
  int copies = 0;  ///< of all of it, or of a part
};

/// `use` outlives the memory.
GstMemory* new_watched_memory(gsize size, MemoryUse& use);

}  // namespace spidar::test
