// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>

namespace footlight::test {

/// True under `scripts/test --full`, which runs the long forms.
inline bool is_full() { return std::getenv("FOOTLIGHT_FULL") != nullptr; }

/// How often a test tries: `quick` as a rule, `full` in the long form.
template <class Number>
Number tries(Number quick, Number full) {
  return is_full() ? full : quick;
}

}  // namespace footlight::test
