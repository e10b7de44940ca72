// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Where the first frame of a FLAC file begins and the last one ends (RFC 9639).
#pragma once

#include <cstdint>
#include <optional>

#include "plugin/films/file_bytes.h"

namespace spidar {

/// In samples of the stream, whose first frame begins after 0 where the beginning was trimmed.
struct FlacLength {
  uint64_t rate_Hz = 0;         ///< 0: there is no header
  uint64_t promised = 0;        ///< by the header; 0: its writer did not know
  uint64_t begin = 0;           ///< of the first frame
  std::optional<uint64_t> end;  ///< of the last whole frame; nothing when none was found
  bool is_cut_off = false;      ///< within the frame after `end`
};

FlacLength flac_length(FileBytes& file);

}  // namespace spidar
