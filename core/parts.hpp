// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/diagnostic.hpp"
#include "core/index.hpp"

namespace footlight {

/// One drawing of a formation that is put together, for some of the people.
struct Part {
  std::optional<GroupIndex> group;  ///< whose places they are; nothing: of everybody in no other part's group
  Position position;
};

}  // namespace footlight
