// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// OpenCV's vectors of 16 bytes: the processor's, or an emulation where it has none. The emulation
/// needs what opencv2/core.hpp declares and does not include it.
#pragma once

#include <opencv2/core.hpp>
#include <opencv2/core/hal/intrin.hpp>
