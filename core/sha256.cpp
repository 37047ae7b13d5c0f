// SPDX-License-Identifier: Apache-2.0
#include "core/sha256.hpp"

#include <bit>

namespace footlight {

Sha256& Sha256::bytes(std::span<const std::uint8_t> data) {
  nettle_sha256_update(&state_, data.size(), data.data());
  return *this;
}

Sha256& Sha256::integer(std::int64_t value) {
  std::array<std::uint8_t, 8> out{};
  for (unsigned i = 0; i < out.size(); ++i) {
    out.at(i) = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i));
  }
  return bytes(out);
}

Sha256& Sha256::real(double value) { return integer(std::bit_cast<std::int64_t>(value == 0 ? 0.0 : value)); }

Sha256& Sha256::text(std::string_view value) {
  integer(static_cast<std::int64_t>(value.size()));
  return bytes({reinterpret_cast<const std::uint8_t*>(value.data()), value.size()});
}

std::array<std::uint8_t, SHA256_DIGEST_SIZE> Sha256::digest() {
  std::array<std::uint8_t, SHA256_DIGEST_SIZE> out{};
  nettle_sha256_digest(&state_, out.size(), out.data());
  return out;
}

std::string Sha256::hex() {
  std::string out;
  for (const std::uint8_t byte : digest()) {
    out += "0123456789abcdef"[byte >> 4U];
    out += "0123456789abcdef"[byte & 15U];
  }
  return out;
}

}  // namespace footlight
