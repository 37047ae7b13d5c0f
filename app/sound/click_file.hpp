// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/sound/count_in.hpp"
#include "core/result.hpp"

namespace footlight::app {

/// A WAV file of clicks, each at its sample. @param start time of the first sample
[[nodiscard]] Status<> write_clicks(const std::string& file, const std::vector<Beat>& beats, Instant start);

}  // namespace footlight::app
