// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/live/live_run.hpp"
#include "core/rig.hpp"

namespace footlight::app {

[[nodiscard]] std::string live_json(const LiveReport& report, const Rig& rig);
[[nodiscard]] std::string live_text(const LiveReport& report);
/// Which nodes were not confirmed at the end, by bus. Only where there are any.
[[nodiscard]] std::string live_failure(const LiveReport& report);

}  // namespace footlight::app
