// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/session.hpp"
#include "core/result.hpp"
#include "core/rig.hpp"
#include "drivers/objection.hpp"

namespace footlight::app {

/// What this machine's settings of the buses' real wires would spoil.
[[nodiscard]] std::vector<drivers::Objection> objections_to(const std::vector<Bus>& buses);

/// Tells what would spoil a show. Errors (ErrorKind::device): all that would stop it, with the commands that mend it.
[[nodiscard]] Status<> check_wires(Session& session, const std::vector<Bus>& buses);

}  // namespace footlight::app
