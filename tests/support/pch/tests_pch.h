// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Precompiled headers that take long to read. No file relies on this one; `meson setup
// -Db_pch=false` builds without it.
#include "tests/support/test.h"
