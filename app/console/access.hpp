// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "core/time.hpp"

namespace footlight::app {

/// What somebody at the console may do; each may what those before may.
enum class Role : std::uint8_t { view, operate, admin };

[[nodiscard]] std::string_view to_text(Role role);
/// "view" and "operate": what a code can be for.
[[nodiscard]] std::optional<Role> paired_role_from(std::string_view text);

/// So many bytes from the system's generator, as hex digits.
[[nodiscard]] std::string random_hex(std::size_t bytes);

/// The admin's token: 256 random bits as 64 hex digits in a file of mode 0600, made when there is none.
/// Errors (ErrorKind::input): the file cannot be read or made, somebody else may read it or owns it, is a link, or does
/// not hold 32 to 256 characters from "!" to "~".
[[nodiscard]] Result<std::string> token_in(const std::filesystem::path& file);

/// By which names browsers may ask for the console: a page of a stranger whose name leads here has another one.
class AllowedHosts {
 public:
  /// @param authority "127.0.0.1:8440", "[::1]:8440", "desk.example" (port 80 or 443 left out as browsers do)
  void add(std::string authority);
  [[nodiscard]] bool has_host(std::string_view host) const;

 private:
  std::vector<std::string> hosts_;  ///< lower case
};

/// Codes that people type once, and the tokens that they get for them. One thread.
class Pairing {
 public:
  static constexpr Duration kGoodFor = milliseconds(120'000);
  static constexpr int kWrongTries = 5;
  static constexpr std::size_t kMostCodes = 8;
  static constexpr std::size_t kMostTokens = 4096;

  /// A code of eight digits; the oldest goes when there are too many.
  [[nodiscard]] std::string make(Role role, Instant now);
  struct Paired {
    std::string token;
    Role role;
  };
  /// Every wrong try counts against all codes that are good: after kWrongTries they are not. A good one is used up.
  [[nodiscard]] std::optional<Paired> redeem(std::string_view code, Instant now);
  /// Looks at every token, whichever it is. O(tokens)
  [[nodiscard]] std::optional<Role> role_of(std::string_view token) const;

 private:
  struct Code {
    std::string digits;
    Role role;
    Instant until;
    int wrong = 0;
  };
  std::vector<Code> codes_;
  std::vector<Paired> tokens_;
};

}  // namespace footlight::app
