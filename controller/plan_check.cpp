// SPDX-License-Identifier: Apache-2.0
#include "controller/plan_check.hpp"

#include <algorithm>
#include <charconv>
#include <string>
#include <system_error>

namespace footlight::controller {
namespace {

/// FNV-1a over cells and times.
std::uint64_t sum_of_marks(const Plan& plan, std::uint64_t sum) {
  for (const auto& track : plan.tracks) {
    for (const Mark& mark : track) {
      sum = (sum ^ mark.cell.value()) * 0x100000001B3ULL;
      sum = (sum ^ static_cast<std::uint64_t>(mark.time.time_since_epoch().count())) * 0x100000001B3ULL;
    }
  }
  return sum;
}

constexpr std::uint64_t kSumBegins = 0xCBF29CE484222325ULL;

}  // namespace

std::uint32_t plan_check_of(const Plan& plan) {
  std::uint64_t sum = kSumBegins;
  for (const char digit : plan.show_hash) sum = (sum ^ static_cast<unsigned char>(digit)) * 0x100000001B3ULL;
  return std::max<std::uint32_t>(1, static_cast<std::uint32_t>(sum_of_marks(plan, sum) >> 32U));
}

std::uint8_t plan_byte_of(const Plan& plan) {
  unsigned byte = 0;
  const std::string& hash = plan.show_hash;
  if (hash.size() >= 2) {
    const auto [end, error] = std::from_chars(hash.data() + hash.size() - 2, hash.data() + hash.size(), byte, 16);
    if (error == std::errc{} && end == hash.data() + hash.size()) return static_cast<std::uint8_t>(byte);
  }
  return static_cast<std::uint8_t>(sum_of_marks(plan, kSumBegins) >> 56U);
}

}  // namespace footlight::controller
