// SPDX-License-Identifier: Apache-2.0
#include "app/commission/lamp_code.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "app/commission/lamps.hpp"
#include "core/check.hpp"

namespace footlight::app {
namespace {

constexpr std::size_t kMostLamps = 65'536;
constexpr double kWeak = 0.5;  // of the median contrast: a bit that may be wrong

std::uint32_t gray(std::uint32_t value) { return value ^ (value >> 1U); }

std::uint32_t from_gray(std::uint32_t code) {
  for (unsigned shift = 1; shift < 32; shift *= 2) code ^= code >> shift;
  return code;
}

}  // namespace

LampCode::LampCode(std::size_t lamps, std::uint8_t tag) : lamps_(lamps), tag_(tag) {
  FL_CHECK(lamps >= 1 && lamps <= kMostLamps);
  data_bits_ = std::max(1, static_cast<int>(std::bit_width(lamps - 1)));
}

std::uint32_t LampCode::word(std::size_t lamp) const {
  FL_CHECK(lamp < lamps_);
  const auto spread = static_cast<std::uint32_t>((lamp << static_cast<unsigned>(data_bits_)) / lamps_);
  const std::uint32_t data = gray(spread);
  return (data << kCheckBits) | static_cast<std::uint32_t>(crc8_bits(data, data_bits_) ^ tag_);
}

bool LampCode::bit(std::size_t lamp, int bit) const {
  return ((word(lamp) >> static_cast<unsigned>(bits() - 1 - bit)) & 1U) != 0;
}

std::optional<std::size_t> LampCode::lamp_of(std::uint32_t word) const {
  const std::uint32_t data = word >> kCheckBits;
  if ((crc8_bits(data, data_bits_) ^ tag_) != (word & 0xFFU)) return std::nullopt;
  const std::size_t spread = from_gray(data);
  const auto all = std::size_t{1} << static_cast<unsigned>(data_bits_);
  const std::size_t lamp = (spread * lamps_ + all - 1) / all;
  if (lamp >= lamps_ || this->word(lamp) != word) return std::nullopt;
  return lamp;
}

LampCode::Read LampCode::read(std::span<const double> contrasts) const {
  FL_CHECK(contrasts.size() == static_cast<std::size_t>(bits()));
  std::uint32_t word = 0;
  std::vector<double> sizes;
  for (const double contrast : contrasts) {
    word = (word << 1U) | (contrast > 0 ? 1U : 0U);
    sizes.push_back(std::abs(contrast));
  }
  if (const auto lamp = lamp_of(word)) return {Outcome::exact, *lamp};
  std::vector<double> sorted = sizes;
  std::ranges::nth_element(sorted, sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2));
  const double median = sorted[sorted.size() / 2];
  for (std::size_t b = 0; b < sizes.size(); ++b) {
    if (sizes[b] >= kWeak * median) continue;
    if (const auto lamp = lamp_of(word ^ (1U << (sizes.size() - 1 - b)))) return {Outcome::corrected, *lamp};
  }
  return {};
}

}  // namespace footlight::app
