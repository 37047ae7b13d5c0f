// SPDX-License-Identifier: Apache-2.0
#include "app/natural_order.hpp"

#include <algorithm>
#include <cstddef>

namespace footlight::app {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The run of digits at `at`.
std::string_view digits_at(std::string_view text, std::size_t at) {
  std::size_t end = at;
  while (end < text.size() && is_digit(text[end])) ++end;
  return text.substr(at, end - at);
}

std::string_view without_zeros(std::string_view digits) {
  const std::size_t first = std::min(digits.find_first_not_of('0'), digits.size());
  return digits.substr(first);
}

}  // namespace

bool natural_less(std::string_view a, std::string_view b) {
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const std::string_view one = digits_at(a, i);
      const std::string_view other = digits_at(b, j);
      const std::string_view x = without_zeros(one);
      const std::string_view y = without_zeros(other);
      if (x.size() != y.size()) return x.size() < y.size();
      if (x != y) return x < y;
      i += one.size();
      j += other.size();
      continue;
    }
    if (a[i] != b[j]) return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[j]);
    ++i;
    ++j;
  }
  if (i < a.size() || j < b.size()) return i == a.size();
  return a.size() != b.size() ? a.size() < b.size() : a < b;  // 07 after 7
}

}  // namespace footlight::app
