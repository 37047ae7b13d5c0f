// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include <nettle/sha2.h>

namespace footlight {

/// SHA-256 (FIPS 180-4, by nettle) over a row of values. Each value is fed so that two different rows of values never
/// give the same bytes: texts with their length first, numbers in eight bytes, little end first.
class Sha256 {
 public:
  Sha256() { nettle_sha256_init(&state_); }

  Sha256& bytes(std::span<const std::uint8_t> data);
  Sha256& integer(std::int64_t value);
  /// +0 and -0 are one value, as they are for ==.
  Sha256& real(double value);
  Sha256& text(std::string_view value);

  /// The sum begins anew.
  std::array<std::uint8_t, SHA256_DIGEST_SIZE> digest();
  /// 64 hex digits, lower case; the sum begins anew.
  [[nodiscard]] std::string hex();

 private:
  sha256_ctx state_{};
};

}  // namespace footlight
