// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Questions and answers on a terminal.
#pragma once

#include <istream>
#include <ostream>

#include "examples/study/answers.h"

namespace study {

/// Asks until the answer is a step, 1 … kSteps. 0 when there is no more input, or it is q: the
/// participant goes on another time.
int ask(const Question& question, std::istream& in, std::ostream& out);

/// Waits for the return key. False when there is no more input, or it is q.
bool wait_for_return(std::istream& in, std::ostream& out);

}  // namespace study
