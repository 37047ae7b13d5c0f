// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/time.hpp"

namespace footlight::app {

/// A tempo that somebody taps.
class TapTempo {
 public:
  /// @param now not before the last tap
  /// @return counts a minute: the slope of the least-squares line through the last taps, at most eight; nothing before
  /// the third. A pause of more than 2.5 s begins anew; a tap within 150 ms of the last one bounced and is left out.
  std::optional<double> tap(Instant now);
  [[nodiscard]] std::size_t taps() const { return taps_.size(); }

 private:
  std::vector<Instant> taps_;
};

}  // namespace footlight::app
