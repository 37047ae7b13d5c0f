// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/command.hpp"

namespace footlight::app {

/// `footlight freeze`: at which counts the show may be stopped at once, and who is in danger where it may not.
void add_freeze_command(CLI::App& program, Session& session, Chosen& chosen);

}  // namespace footlight::app
