// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/plan.hpp"

namespace footlight::controller {

/// The byte of a plan that all frames of a show carry: the last two digits of its hash; a sum over its marks where it
/// has none. Drivers are made with it.
[[nodiscard]] std::uint8_t plan_byte_of(const Plan& plan);

/// What nodes are told of a plan, over its hash and its marks; never 0.
[[nodiscard]] std::uint32_t plan_check_of(const Plan& plan);

}  // namespace footlight::controller
