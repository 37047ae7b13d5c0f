// SPDX-License-Identifier: Apache-2.0
#include "app/numbers.hpp"

#include <array>
#include <charconv>
#include <cmath>

#include "core/check.hpp"

namespace footlight::app {

std::string exact(double value) {
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  FL_CHECK(error == std::errc{});
  return {text.data(), end};
}

std::string exact_seconds(Instant instant) {
  const std::int64_t ns = instant.time_since_epoch().count();
  const std::uint64_t size = ns < 0 ? ~static_cast<std::uint64_t>(ns) + 1 : static_cast<std::uint64_t>(ns);
  std::string out = (ns < 0 ? "-" : "") + std::to_string(size / 1'000'000'000);
  std::string decimals = std::to_string(1'000'000'000 + size % 1'000'000'000).substr(1);
  while (!decimals.empty() && decimals.back() == '0') decimals.pop_back();
  return decimals.empty() ? out : out + "." + decimals;
}

double tidy_count(double count) { return std::round(count * 1e9) / 1e9; }

std::size_t section_at(const Plan& plan, Instant instant) {
  FL_CHECK(!plan.sections.empty());
  for (std::size_t i = 0; i < plan.sections.size(); ++i) {
    if (plan.sections[i].end >= instant) return i;
  }
  return plan.sections.size() - 1;
}

}  // namespace footlight::app
