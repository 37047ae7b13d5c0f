// SPDX-License-Identifier: Apache-2.0
#include "core/secret.hpp"

#include <nettle/memops.h>

namespace footlight {

bool same_secret(std::string_view one, std::string_view other) {
  return one.size() == other.size() && nettle_memeql_sec(one.data(), other.data(), one.size()) != 0;
}

}  // namespace footlight
