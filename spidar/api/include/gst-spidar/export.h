// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// \file
/// Marks what libgst-spidar exports; everything else in it is hidden.
#pragma once

/// Put before a class or function that programs link; it has no effect on them.
#define GST_SPIDAR_API __attribute__((visibility("default")))
