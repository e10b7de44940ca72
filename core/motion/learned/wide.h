// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Loops over floats, compiled a second time for processors with wider vectors.
#pragma once

/// Becomes part of the function that calls it, and is compiled for the same processor.
#define SPIDAR_INLINED __attribute__((always_inline)) inline

/// SPIDAR_WIDE(name, (parameters), (arguments)) defines the function `name`, which calls the
/// inlined function `name_inlined` in the version for this processor.
#if defined(__x86_64__) && defined(__GNUC__)
#define SPIDAR_WIDE(name, parameters, arguments)                                   \
  __attribute__((target("avx2,fma"))) void name##_wide parameters {                \
    name##_inlined arguments;                                                      \
  }                                                                                \
  void name parameters {                                                           \
    static const bool is_wide =                                                    \
        __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0; \
    if (is_wide) {                                                                 \
      name##_wide arguments;                                                       \
    } else {                                                                       \
      name##_inlined arguments;                                                    \
    }                                                                              \
  }
#else
#define SPIDAR_WIDE(name, parameters, arguments) \
  void name parameters {                         \
    name##_inlined arguments;                    \
  }
#endif
