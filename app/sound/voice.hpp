// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <string>

#include "app/sound/samples.hpp"
#include "core/result.hpp"

namespace footlight::app {

/// The numbers 1 to 8, spoken; each begins with its first sound.
struct Voice {
  std::array<std::shared_ptr<const Samples>, 9> numbers{};  ///< [1] to [8]
};

/// By the program espeak-ng, where it is installed: nothing of it is linked. Eight short calls, each ended after 5 s.
/// @param language as espeak-ng calls it: "en", "de", "cmn"  Errors (ErrorKind::device): it is not there, does not know
/// the language, or what it says cannot be read.
[[nodiscard]] Result<Voice> speak_numbers(const std::string& language);

}  // namespace footlight::app
