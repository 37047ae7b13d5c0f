// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/command.hpp"

namespace footlight::app {

/// `footlight journal`: what happened in a run.
void add_journal_command(CLI::App& program, Session& session, Chosen& chosen);

}  // namespace footlight::app
