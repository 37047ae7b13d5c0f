// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "app/journal/place.hpp"

namespace footlight::app {

// What a leading run and its understudy say to each other: lines of JSON over TCP (docs/surviving.md).

/// The longest line that is read.
inline constexpr std::size_t kLongestLeadLine = 16'384;
/// The leading run says where the show is this often, while its cue thread lives.
inline constexpr Duration kLeadEvery = milliseconds(100);
/// Of such a silence the understudy takes over (T1 of the trust model).
inline constexpr Duration kLeadSilence = milliseconds(1000);

/// {"follow": 1, "plan": digest, "token": text}: the understudy's first line.
struct FollowRequest {
  std::string plan;
  std::string token;
};
[[nodiscard]] std::string line_of(const FollowRequest& request);
[[nodiscard]] std::optional<FollowRequest> follow_request(std::string_view line);

/// {"leads": epoch}: it may follow.
[[nodiscard]] std::string leads_line(std::uint32_t epoch);
[[nodiscard]] std::optional<std::uint32_t> leads_in(std::string_view line);

/// {"refused": why}
[[nodiscard]] std::string refused_line(std::string_view why);
[[nodiscard]] std::optional<std::string> refused_in(std::string_view line);

/// {"place": {...}}. Instants of the clock go over the wire as ages, so that no two clocks have to agree.
/// @param now of `machine_time` of whoever says or hears it
[[nodiscard]] std::string place_line(const Place& place, Duration now);
[[nodiscard]] std::optional<Place> place_in(std::string_view line, Duration now);

/// {"over": how}: the run ends of its own will; nobody is to take over.
[[nodiscard]] std::string over_line(std::string_view how);
[[nodiscard]] std::optional<std::string> over_in(std::string_view line);

/// {"take_over": epoch}: the understudy leads from now on.
[[nodiscard]] std::string take_over_line(std::uint32_t epoch);
[[nodiscard]] std::optional<std::uint32_t> take_over_in(std::string_view line);

}  // namespace footlight::app
