// SPDX-License-Identifier: Apache-2.0
#include "drivers/transports/urls.hpp"

#include <gtest/gtest.h>

namespace footlight::drivers {
namespace {

std::string refusal_of(std::string_view place) {
  const auto parsed = parse_host_and_port(place, 502);
  return parsed ? "" : parsed.error().message;
}

TEST(Urls, HaveASchemeAndAPlace) {
  EXPECT_EQ(scheme_of("serial:///dev/ttyS0"), "serial");
  EXPECT_EQ(place_of("serial:///dev/ttyS0"), "/dev/ttyS0");
  EXPECT_EQ(scheme_of("/dev/ttyS0"), "");
  EXPECT_EQ(place_of("/dev/ttyS0"), "");
}

TEST(HostAndPort, MayHaveAPortAndAnAddressOfVersion6) {
  EXPECT_EQ(*parse_host_and_port("marker.local", 502), (HostAndPort{"marker.local", 502}));
  EXPECT_EQ(*parse_host_and_port("10.0.0.7:1502", 502), (HostAndPort{"10.0.0.7", 1502}));
  EXPECT_EQ(*parse_host_and_port("[fe80::1]", 502), (HostAndPort{"fe80::1", 502}));
  EXPECT_EQ(*parse_host_and_port("[fe80::1]:65535", 502), (HostAndPort{"fe80::1", 65'535}));
}

TEST(HostAndPort, WhatIsNoneIsRefused) {
  EXPECT_EQ(refusal_of(""), "\"\": no host (host:502 or [IPv6 address]:502)");
  EXPECT_EQ(refusal_of(":502"), "\":502\": no host (host:502 or [IPv6 address]:502)");
  EXPECT_EQ(refusal_of("[fe80::1"), "\"[fe80::1\": the bracket is not closed (host:502 or [IPv6 address]:502)");
  EXPECT_EQ(refusal_of("[fe80::1]502"),
            "\"[fe80::1]502\": only a port may follow the bracket (host:502 or [IPv6 address]:502)");
  for (const char* place : {"host:", "host:0", "host:65536", "host:5o2", "host:-1", "fe80::1"}) {
    EXPECT_EQ(refusal_of(place),
              "\"" + std::string(place) + "\": the port is not a number of 1..65535 (host:502 or [IPv6 address]:502)");
  }
}

}  // namespace
}  // namespace footlight::drivers
