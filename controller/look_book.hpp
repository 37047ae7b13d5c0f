// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "controller/lamp.hpp"
#include "core/look.hpp"
#include "core/show.hpp"

namespace footlight::controller {

/// All possible looks by (colour, role, pattern). Numbers are given to those that are used.
class LookBook {
 public:
  LookBook(const Show& show, std::size_t performers) {
    std::map<Colour, std::uint32_t> numbers;
    for (std::size_t p = 0; p < performers; ++p) {
      const auto& group = p < show.performers.size() ? show.performers[p].group : std::nullopt;
      const Colour colour = group ? show.groups.at(group->at()).colour : show.default_colour;
      colour_of_.push_back(numbers.try_emplace(colour, static_cast<std::uint32_t>(numbers.size())).first->second);
    }
    std::vector<Colour> colours(numbers.size());
    for (const auto& [colour, number] : numbers) colours[number] = colour;
    for (const Colour colour : colours) {
      for (int r = 0; r < kLampRoles; ++r) {
        const auto found = show.looks.find(static_cast<LampRole>(r));
        const LookChoice choice = found != show.looks.end() ? found->second : default_choice(static_cast<LampRole>(r));
        const Look look{choice.colour.value_or(colour), choice.effect, choice.brightness};
        for (int pattern = 0; pattern < kPatterns; ++pattern) looks_.push_back(with_pattern(look, pattern));
      }
    }
  }

  /// Place of a lamp's look in the book.
  [[nodiscard]] std::uint16_t entry(const Lamp& lamp, int pattern) const {
    const auto role = static_cast<std::size_t>(*lamp.role);
    return static_cast<std::uint16_t>((colour_of_[lamp.whose.at()] * kLampRoles + role) * kPatterns +
                                      static_cast<std::size_t>(pattern));
  }
  [[nodiscard]] const Look& look(std::uint16_t entry) const { return looks_[entry]; }
  [[nodiscard]] std::size_t size() const { return looks_.size(); }
  /// Those that are most like an entry, best first: other patterns, then other roles of the same colour.
  [[nodiscard]] static std::array<std::uint16_t, kLampRoles * kPatterns> like(std::uint16_t entry) {
    const auto colour = static_cast<std::size_t>(entry) / (kLampRoles * kPatterns);
    const auto role = static_cast<std::size_t>(entry) / kPatterns % kLampRoles;
    std::array<std::uint16_t, kLampRoles * kPatterns> list{};
    for (std::size_t i = 0; i < list.size(); ++i) {
      const std::size_t r = (role + i / kPatterns) % kLampRoles;
      const std::size_t pattern = (static_cast<std::size_t>(entry) + i) % kPatterns;
      list[i] = static_cast<std::uint16_t>((colour * kLampRoles + r) * kPatterns + pattern);
    }
    return list;
  }
  /// Most looks that a show can need with so many patterns.
  [[nodiscard]] std::size_t different(int patterns) const {
    std::vector<Look> list;
    for (std::size_t i = 0; i < looks_.size(); ++i) {
      if (static_cast<int>(i % kPatterns) < patterns) list.push_back(looks_[i]);
    }
    std::sort(list.begin(), list.end());
    return static_cast<std::size_t>(std::unique(list.begin(), list.end()) - list.begin());
  }

 private:
  std::vector<std::uint32_t> colour_of_;
  std::vector<Look> looks_;
};

}  // namespace footlight::controller
