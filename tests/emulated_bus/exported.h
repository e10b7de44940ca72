// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Marks what the library of the emulated bus exports: what tests call, and what stands before the
/// functions of libc and libudev.
#pragma once

#define BUS_API __attribute__((visibility("default")))
