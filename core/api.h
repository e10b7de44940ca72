// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Marks what a folder offers to the others. Nothing of it is exported: programs that are not of
/// this tree have include/gst-spidar/.
#pragma once

#define SPIDAR_API
