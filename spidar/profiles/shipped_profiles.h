// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The profiles of spidar/profiles/shipped/, which are part of the library.
#pragma once

namespace spidar {

struct ShippedProfile {
  const char* name;  ///< of the file, without ending
  const char* text;  ///< TOML
};

struct ShippedProfiles {
  const ShippedProfile* first;
  const ShippedProfile* last;  ///< one past the end
  const ShippedProfile* begin() const noexcept { return first; }
  const ShippedProfile* end() const noexcept { return last; }
};

/// All of them, sorted by name.
ShippedProfiles shipped_profiles() noexcept;

}  // namespace spidar
