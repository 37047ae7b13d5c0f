// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/clock.hpp"

namespace footlight::app {

/// How long each stage of a command took. A stage lasts until another one is entered; one that comes again adds up.
class StageTimes {
 public:
  explicit StageTimes(const Clock& clock) : clock_(clock), since_(clock.now()) {}

  void enter(std::string_view stage);
  /// The stages in the order in which they were first entered, seconds, until now.
  [[nodiscard]] const std::vector<std::pair<std::string, double>>& finish();

 private:
  const Clock& clock_;
  Instant since_;
  std::size_t now_ = 0;
  std::vector<std::pair<std::string, double>> stages_;
};

/// "decoding 1.61 s, pairing 0.80 s, all 2.41 s, 96 MB at most"
[[nodiscard]] std::string to_text(const std::vector<std::pair<std::string, double>>& stages, double peak_mb);

/// The most memory that this process has had, MB; without the decoder, which is a process of its own.
[[nodiscard]] double peak_memory_mb();

}  // namespace footlight::app
