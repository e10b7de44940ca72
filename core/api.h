// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Marks what the shared libraries export; everything else is hidden.
#pragma once

#define SPIDAR_API __attribute__((visibility("default")))
