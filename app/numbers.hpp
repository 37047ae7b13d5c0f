// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "core/plan.hpp"
#include "core/time.hpp"

namespace footlight::app {

/// Shortest text that reads back as the same double.
[[nodiscard]] std::string exact(double value);
/// Seconds, exact to the nanosecond, without trailing zeros: "3.2".
[[nodiscard]] std::string exact_seconds(Instant instant);
/// A count to the billionth, without trailing zeros: what a count that was computed from an instant is worth.
[[nodiscard]] double tidy_count(double count);

/// The section an instant belongs to: the walk into a section's first formation is its own, so it is the first that
/// ends at the instant or later. The last one after the end. The plan has sections.
[[nodiscard]] std::size_t section_at(const Plan& plan, Instant instant);

}  // namespace footlight::app
