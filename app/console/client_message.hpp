// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "app/console/access.hpp"
#include "core/result.hpp"

namespace footlight::app {

/// What a client of the console says (docs/console.md).
struct Hello {
  std::string name;  ///< 1 to 40 characters, none of them a control character
  std::string token;
  Role most = Role::admin;  ///< she asks for no more than that
};
struct OrderSaid {
  std::string line;  ///< at most 256 bytes, no control characters
  std::optional<std::uint64_t> id;
};
struct SeatWish {
  bool take = true;
};
struct Acknowledge {
  std::uint64_t alarm = 0;
};
struct PairWish {
  Role role = Role::view;
};
struct Ping {
  std::uint64_t number = 0;
};
using ClientMessage = std::variant<Hello, OrderSaid, SeatWish, Acknowledge, PairWish, Ping>;

inline constexpr std::size_t kLongestMessage = 4096;  ///< bytes
inline constexpr std::size_t kLongestOrder = 256;
inline constexpr std::size_t kLongestName = 40;

/// Errors (ErrorKind::input): not UTF-8, not one JSON object, none or several of the known keys, a value that is none.
[[nodiscard]] Result<ClientMessage> client_message_from(std::string_view text);

/// The code in the body of POST /api/pair; spaces and hyphens do no harm. Errors as above.
[[nodiscard]] Result<std::string> code_from(std::string_view body);

/// Whether an order is a HOLD of some kind, which every operator may always say.
[[nodiscard]] bool is_hold(std::string_view order);
/// Its first word in lower case.
[[nodiscard]] std::string verb_of(std::string_view order);

}  // namespace footlight::app
