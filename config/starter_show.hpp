// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace footlight::config {

/// The files of a new show, name and content: a commented show.yaml with twelve people on a small stage and three
/// formations in CSV files, and the schema by which an editor completes and checks it. It loads, plans and dry-runs as
/// it is.
/// @param title any text; it is quoted where YAML needs it
[[nodiscard]] std::vector<std::pair<std::string, std::string>> starter_show(std::string_view title);

}  // namespace footlight::config
