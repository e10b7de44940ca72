// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Marks the functions that a folder offers to the others. They are not exported: other programs
/// use include/gst-spidar/.
#pragma once

#define SPIDAR_API
