// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace footlight::app {

/// The order in which people look for names: runs of digits count as numbers, so that D2 comes before D10. Equal
/// numbers with more leading zeros come later; everything else by bytes. A strict weak order.
[[nodiscard]] bool natural_less(std::string_view a, std::string_view b);

}  // namespace footlight::app
