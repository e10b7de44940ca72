// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Marks the functions that the library of the emulated bus exports: those that tests call, and
/// those that replace functions of libc and libudev.
#pragma once

#define BUS_API __attribute__((visibility("default")))
