// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/command.hpp"

namespace footlight::app {

/// `footlight cast`.
void add_cast_command(CLI::App& program, Session& session, Chosen& chosen);

}  // namespace footlight::app
