// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Asks questions on a terminal.
#pragma once

#include <istream>
#include <ostream>

#include "apps/study/answers.h"

namespace study {

/// Asks until the answer is a step, 1 … kSteps. Returns 0 at the end of input or when the answer is
/// q: the participant continues another time.
int ask(const Question& question, std::istream& in, std::ostream& out);

/// Waits for the return key. Returns false at the end of input or when the answer is q.
bool wait_for_return(std::istream& in, std::ostream& out);

}  // namespace study
