// SPDX-License-Identifier: Apache-2.0
#include "core/check.hpp"

#include <cstdio>
#include <cstdlib>

namespace footlight {

void check_failed(const char* expression, const char* file, int line) noexcept {
  (void)std::fprintf(stderr, "%s:%d: internal error: expected %s\n", file, line, expression);
  std::abort();
}

}  // namespace footlight
