// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "app/session.hpp"

namespace footlight::app {

/// What the command line has chosen: runs it and gives the exit status.
using Chosen = std::function<int()>;

/// Adds a subcommand to the program. When it is the one on the command line, its work goes to `chosen`; nothing is done
/// while the command line is still read. Each command is one file and one line of the table in app/main.cpp.
using AddCommand = void (*)(CLI::App& program, Session& session, Chosen& chosen);

}  // namespace footlight::app
