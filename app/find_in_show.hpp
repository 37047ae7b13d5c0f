// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/index.hpp"
#include "core/plan.hpp"
#include "core/result.hpp"
#include "core/show.hpp"

namespace footlight::app {

/// By id, else by name. Errors: nobody is called so, with who was perhaps meant.
[[nodiscard]] Result<PerformerIndex> find_performer(const Show& show, const std::string& word);
[[nodiscard]] Result<GroupIndex> find_group(const Show& show, const std::string& word);
/// The section of a painting: of this name, or the only one. @param word empty: the only one
[[nodiscard]] Result<SectionIndex> find_painting(const Show& show, const std::string& word);
/// By id, as "growth/12".
[[nodiscard]] Result<FormationIndex> find_formation(const Plan& plan, const std::string& word);

}  // namespace footlight::app
