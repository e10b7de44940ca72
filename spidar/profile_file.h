/// From a profile file's text to a Profile; looking files up is in profile.h.
#pragma once

#include <string>

#include "spidar/profile.h"

namespace spidar {

/// Reads and checks one profile. `text` is TOML, `path` is only for messages, `name` becomes
/// Profile::name. Every key is known, every number finite and in its range, every table as long as
/// there are strings. Tables in the left-handed frame (x right, y up, z away from the user) are
/// turned into D by z → −z. Throws ProfileError.
Profile parse_profile(const std::string& text, const std::string& path, const std::string& name);

}  // namespace spidar
