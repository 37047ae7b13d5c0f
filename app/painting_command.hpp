// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/command.hpp"

namespace footlight::app {

/// `footlight painting`.
void add_painting_command(CLI::App& program, Session& session, Chosen& chosen);

}  // namespace footlight::app
