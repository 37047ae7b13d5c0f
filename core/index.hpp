// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace footlight {

/// A position in one kind of list, counted from 0. Indices of different lists do not compile into each other.
/// Inside a program only; what files and people see are stable ids (strings).
template <class Tag>
class Index {
 public:
  constexpr Index() = default;
  constexpr explicit Index(std::uint32_t value) : value_(value) {}
  template <class Integer>
  constexpr static Index of(Integer value) {
    return Index(static_cast<std::uint32_t>(value));
  }

  [[nodiscard]] constexpr std::uint32_t value() const { return value_; }
  /// For subscripts: `list[index.at()]`.
  [[nodiscard]] constexpr std::size_t at() const { return value_; }

  friend constexpr auto operator<=>(Index, Index) = default;

 private:
  std::uint32_t value_ = 0;
};

using PerformerIndex = Index<struct PerformerTag>;
using GroupIndex = Index<struct GroupTag>;
using CellIndex = Index<struct CellTag>;
using SectionIndex = Index<struct SectionTag>;
using FormationIndex = Index<struct FormationTag>;
using BusIndex = Index<struct BusTag>;
using NodeIndex = Index<struct NodeTag>;
using MarkerIndex = Index<struct MarkerTag>;
/// A look is one byte on every wire: the index of a look table of at most 256 entries. 0 is always dark.
using LookIndex = std::uint8_t;

}  // namespace footlight

template <class Tag>
struct std::hash<footlight::Index<Tag>> {  // NOLINT(cert-dcl58-cpp): a hash of one's own type is what std allows
  std::size_t operator()(footlight::Index<Tag> index) const noexcept { return index.value(); }
};
