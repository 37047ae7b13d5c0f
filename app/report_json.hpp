// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/report_page.hpp"
#include "core/plan.hpp"
#include "core/show.hpp"

namespace footlight::app {

/// Every figure that a report draws, as one JSON document; its keys are those of docs/report.md.
/// @param files  what was written besides
[[nodiscard]] std::string report_json(const Plan& plan, const Show& show, const ReportFacts& facts,
                                      const std::vector<std::string>& files);

}  // namespace footlight::app
