// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "core/result.hpp"
#include "planner/stages.hpp"

namespace footlight::app {

/// Names this very program: stages of another build are not trusted. Empty when the linker has given it no build id.
[[nodiscard]] std::string build_id();

/// Writes what the stages of a planning gave, whole or not at all.
[[nodiscard]] Status<> save_stages(const planner::Stages& stages, const std::string& file);

/// Reads them into `stages`. Errors (ErrorKind::input), as the end of a sentence: it cannot be read, is of another
/// build, or is harmed (its digest says so); then `stages` is what it was.
[[nodiscard]] Status<> load_stages(const std::string& file, planner::Stages& stages);

}  // namespace footlight::app
