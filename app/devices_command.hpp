// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/command.hpp"

namespace footlight::app {

/// footlight devices list | scan | identify | set-address | health | test: what a technician does with the markers.
void add_devices_command(CLI::App& program, Session& session, Chosen& chosen);

}  // namespace footlight::app
