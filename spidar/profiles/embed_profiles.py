#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Writes the shipped profiles into the library: embed_profiles.py OUTPUT.cpp PROFILE.toml..."""

import sys
from pathlib import Path

END = "profile"  # of a raw string; no profile has )profile" in it

output, *files = map(Path, sys.argv[1:])
rows = "".join(f'    {{"{file.stem}", R"{END}({file.read_text(encoding="utf-8")}){END}"}},\n' for file in files)
output.write_text(
    f"""// Made by spidar/profiles/embed_profiles.py from spidar/profiles/shipped/.
#include "spidar/profiles/profile_file.h"

namespace spidar {{

const std::map<std::string, const char*>& shipped_profiles() {{
  static const std::map<std::string, const char*> all{{
{rows}}};
  return all;
}}

}}  // namespace spidar
""",
    encoding="utf-8",
)
