// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/command.hpp"

namespace footlight::app {

/// footlight sheets SHOW -o DIR|FILE.pdf
void add_sheets_command(CLI::App& program, Session& session, Chosen& chosen);

}  // namespace footlight::app
