// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace footlight::drivers {

/// The scheme of a bus's URL, without "://"; empty when there is none.
[[nodiscard]] std::string_view scheme_of(std::string_view url);
/// What stands behind "://".
[[nodiscard]] std::string_view place_of(std::string_view url);

struct HostAndPort {
  std::string host;
  int port = 0;

  friend bool operator==(const HostAndPort&, const HostAndPort&) = default;
};
/// "host", "host:502", "[2001:db8::1]:502". Errors: ErrorKind::input.
[[nodiscard]] Result<HostAndPort> parse_host_and_port(std::string_view place, int default_port);

}  // namespace footlight::drivers
