// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace footlight::app {

/// For text and attributes (in double quotes) of HTML.
[[nodiscard]] std::string escaped(std::string_view text);

/// For a part of a web address: bytes that are no unreserved characters become %XX (RFC 3986, 2.1 and 2.3).
[[nodiscard]] std::string percent_encoded(std::string_view text);

}  // namespace footlight::app
