// SPDX-License-Identifier: Apache-2.0
#include "app/import/imported.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace footlight::app {

FastestWalk fastest_walk(const Imported& imported, const TempoMap& tempo) {
  FastestWalk out;
  const auto& formations = imported.formations;
  for (std::size_t f = 1; f < formations.size(); ++f) {
    const ImportedFormation& before = formations[f - 1];
    const double walk_s = to_seconds(tempo.at(formations[f].count) - tempo.at(before.count + before.hold_counts));
    for (std::size_t p = 0; p < imported.people.size(); ++p) {
      const double speed_mps = distance(formations[f].places[p].at, before.places[p].at) / walk_s;
      if (speed_mps > out.speed_mps) out = {speed_mps, p, f};
    }
  }
  return out;
}

Error first_errors(const Diagnostics& diagnostics) {
  constexpr std::size_t kShown = 20;
  const std::vector<Diagnostic> sorted = diagnostics.sorted();
  std::string text;
  for (std::size_t i = 0; i < std::min(sorted.size(), kShown); ++i) text += to_text(sorted[i]) + "\n";
  if (sorted.size() > kShown) text += fmt::format("and {} more\n", sorted.size() - kShown);
  text.pop_back();
  return input_error(text);
}

}  // namespace footlight::app
