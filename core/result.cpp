// SPDX-License-Identifier: Apache-2.0
#include "core/result.hpp"

#include <ostream>

namespace footlight {

std::ostream& operator<<(std::ostream& out, const Error& error) { return out << error.message; }

}  // namespace footlight
