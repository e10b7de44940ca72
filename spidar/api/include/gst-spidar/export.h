// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// \file
/// Marks what libgst-spidar exports; everything else in it is hidden.
#pragma once

/// Exports a class or function of the library; has no effect on programs that link it.
#define GST_SPIDAR_API __attribute__((visibility("default")))
