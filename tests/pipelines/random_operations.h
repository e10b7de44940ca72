// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Random operations of users, applications and streams on a player.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/pipelines/tormented_player.h"
#include "tests/support/random_source.h"

namespace spidar::test {

struct Operation {
  std::string name;
  int weight;  ///< relative frequency
  std::function<void(TormentedPlayer&, RandomSource&)> run;
};

/// Operations during which another thread may stop the player: none of them changes the state or
/// needs the device.
std::vector<Operation> interruptible_operations(const TormentedPlayer& player);
/// All other operations.
std::vector<Operation> other_operations();

/// One of them at random, by weight.
const Operation& draw(const std::vector<Operation>& operations, RandomSource& random);

}  // namespace spidar::test
