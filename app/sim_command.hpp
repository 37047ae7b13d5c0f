// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/command.hpp"

namespace footlight::app {

/// footlight sim: the markers of a rig, simulated, on ports that other programs open.
void add_sim_command(CLI::App& program, Session& session, Chosen& chosen);

}  // namespace footlight::app
