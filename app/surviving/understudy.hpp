// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "app/surviving/lead_line.hpp"
#include "core/file_descriptor.hpp"
#include "core/result.hpp"

namespace footlight::app {

/// When an understudy takes over. Pure: what was heard and when comes in, what to do comes out.
class FollowedLead {
 public:
  /// What a line says. @param now of `machine_time`  @return why following ends; empty: it goes on
  std::string hear(std::string_view line, Duration now);
  /// Nothing was heard for `kLeadSilence` of a lead that was followed.
  [[nodiscard]] bool is_lost(Duration now) const { return place_ && now - heard_at_ >= kLeadSilence; }
  [[nodiscard]] const std::optional<Place>& place() const { return place_; }
  [[nodiscard]] std::uint32_t epoch() const { return epoch_; }

 private:
  std::optional<Place> place_;
  Duration heard_at_{};
  std::uint32_t epoch_ = 0;
};

/// An understudy leads so many epochs later: the first counts on by one at each beginning, and stays behind.
inline constexpr std::uint32_t kEpochsAhead = 1000;

/// What an understudy takes over.
struct TakenOver {
  Place place{};
  std::uint32_t epoch = 0;  ///< to lead under
  std::string because;      ///< for people
};

struct FollowSettings {
  std::string host;
  int port = 0;
  std::string token;
  std::string plan;                     ///< config::digest_of
  std::function<bool()> wants_to_lead;  ///< the operator's key; asked some twenty times a second
  std::function<void(const std::string&)> note;
  const std::atomic<bool>* stop = nullptr;
};

/// Follows a leading run until it falls silent for `kLeadSilence`, or the operator wants to lead: then it is told, as
/// far as it hears. Until there was a lead for the first time nothing is taken over. Errors: refused by the lead; it
/// has ended of its own will; interrupted.
[[nodiscard]] Result<TakenOver> follow(const FollowSettings& settings);

}  // namespace footlight::app
