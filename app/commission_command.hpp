// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/command.hpp"

namespace footlight::app {

/// `footlight commission`: which lamp is on which cell, by walk, by film and by wipes.
void add_commission_command(CLI::App& program, Session& session, Chosen& chosen);

}  // namespace footlight::app
