// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/plan.hpp"

namespace footlight::config {

/// Hex SHA-256 over everything a plan says. Two plans that differ in anything (==) have different digests; it does not
/// depend on how a file lays them out.
[[nodiscard]] std::string digest_of(const Plan& plan);

}  // namespace footlight::config
