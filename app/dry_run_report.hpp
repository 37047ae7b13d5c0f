// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/dry_run.hpp"

namespace footlight::app {

/// The document of `footlight dryrun --json`, ended by a newline.
[[nodiscard]] std::string dry_run_json(const DryRunReport& report);
/// The same for people.
[[nodiscard]] std::string dry_run_text(const DryRunReport& report);
/// Why the run was not good enough, one line for each cue; empty when every marker was right.
[[nodiscard]] std::string dry_run_failure(const DryRunReport& report);

}  // namespace footlight::app
