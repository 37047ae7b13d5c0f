// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/urls.hpp"

#include <charconv>

namespace footlight::drivers {
namespace {

constexpr std::string_view kSeparator = "://";
constexpr int kLastPort = 65'535;

}  // namespace

std::string_view scheme_of(std::string_view url) {
  const auto end = url.find(kSeparator);
  return end == std::string_view::npos ? std::string_view{} : url.substr(0, end);
}

std::string_view place_of(std::string_view url) {
  const auto end = url.find(kSeparator);
  return end == std::string_view::npos ? std::string_view{} : url.substr(end + kSeparator.size());
}

Result<HostAndPort> parse_host_and_port(std::string_view place, int default_port) {
  const auto wrong = [&](const std::string& what) {
    return input_error("\"" + std::string(place) + "\": " + what + " (host:502 or [IPv6 address]:502)");
  };
  std::string_view host = place;
  std::string_view port;
  if (place.starts_with('[')) {
    const auto end = place.find(']');
    if (end == std::string_view::npos) return wrong("the bracket is not closed");
    host = place.substr(1, end - 1);
    const std::string_view rest = place.substr(end + 1);
    if (!rest.empty() && rest.front() != ':') return wrong("only a port may follow the bracket");
    if (!rest.empty()) port = rest;
  } else if (const auto colon = place.find(':'); colon != std::string_view::npos) {
    host = place.substr(0, colon);
    port = place.substr(colon);
  }
  if (host.empty()) return wrong("no host");
  if (port.empty()) return HostAndPort{std::string(host), default_port};
  port.remove_prefix(1);
  int number = 0;
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), number);
  if (error != std::errc{} || end != port.data() + port.size() || number < 1 || number > kLastPort) {
    return wrong("the port is not a number of 1..65535");
  }
  return HostAndPort{std::string(host), number};
}

}  // namespace footlight::drivers
