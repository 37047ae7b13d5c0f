// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace footlight::app {

/// The word that each lamp flashes: its number as a reflected binary (Gray) code, spread over all numbers of that many
/// bits so that in each of them about half of the lamps shine, and eight check bits: a CRC-8 xor a tag of the rig.
/// Words differ in at least four bits: one wrong bit can be put right, two or three are noticed.
class LampCode {
 public:
  static constexpr int kCheckBits = 8;

  /// @param lamps 1..65,536  @param tag of the rig: words of another tag are not read
  LampCode(std::size_t lamps, std::uint8_t tag);

  [[nodiscard]] std::size_t lamps() const { return lamps_; }
  /// Data and check bits of a word, at most 24.
  [[nodiscard]] int bits() const { return data_bits_ + kCheckBits; }
  /// What lamp `lamp` shows in bit `bit`, 0..bits() - 1, the first to be shown first.
  [[nodiscard]] bool bit(std::size_t lamp, int bit) const;
  /// All of it, the first bit as the most significant one.
  [[nodiscard]] std::uint32_t word(std::size_t lamp) const;

  enum class Outcome { exact, corrected, wrong };
  struct Read {
    Outcome outcome = Outcome::wrong;
    std::size_t lamp = 0;  ///< unless wrong
  };
  /// Whose word is this? A bit is corrected only where its contrast is below half of the median.
  /// @param contrasts one for each bit, -1..1: above 0 the bit is 1; the further from 0, the surer
  [[nodiscard]] Read read(std::span<const double> contrasts) const;

 private:
  [[nodiscard]] std::optional<std::size_t> lamp_of(std::uint32_t word) const;
  std::size_t lamps_;
  std::uint8_t tag_;
  int data_bits_ = 1;
};

}  // namespace footlight::app
