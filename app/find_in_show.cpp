// SPDX-License-Identifier: Apache-2.0
#include "app/find_in_show.hpp"

#include <algorithm>
#include <optional>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "config/nearest.hpp"

namespace footlight::app {

Result<PerformerIndex> find_performer(const Show& show, const std::string& word) {
  std::vector<std::string> known;
  for (std::size_t p = 0; p < show.performers.size(); ++p) {
    if (show.performers[p].id == word) return PerformerIndex::of(p);
    known.push_back(show.performers[p].id);
  }
  for (std::size_t p = 0; p < show.performers.size(); ++p) {
    if (show.performers[p].name == word) return PerformerIndex::of(p);
    known.push_back(show.performers[p].name);
  }
  return input_error(fmt::format("there is no performer {} ({})", config::in_quotes(word),
                                 config::suggestion(word, known, "performers")));
}

Result<GroupIndex> find_group(const Show& show, const std::string& word) {
  std::vector<std::string> known;
  for (std::size_t g = 0; g < show.groups.size(); ++g) {
    if (show.groups[g].name == word) return GroupIndex::of(g);
    known.push_back(show.groups[g].name);
  }
  if (known.empty())
    return input_error(fmt::format("there is no group {} (the show has none)", config::in_quotes(word)));
  return input_error(
      fmt::format("there is no group {} ({})", config::in_quotes(word), config::suggestion(word, known, "groups")));
}

Result<SectionIndex> find_painting(const Show& show, const std::string& word) {
  std::vector<std::string> known;
  std::vector<std::string> paintings;
  std::optional<SectionIndex> last;
  for (std::size_t s = 0; s < show.sections.size(); ++s) {
    const Section& section = show.sections[s];
    const bool painted = std::holds_alternative<PaintingSource>(section.from);
    if (painted && section.name == word) return SectionIndex::of(s);
    known.push_back(section.name);
    if (!painted) continue;
    paintings.push_back(section.name);
    last = SectionIndex::of(s);
  }
  if (!word.empty() && std::ranges::find(known, word) == known.end()) {
    return input_error(fmt::format("there is no section {} ({})", config::in_quotes(word),
                                   config::suggestion(word, known, "sections")));
  }
  if (paintings.empty()) {
    return input_error(
        fmt::format("no section of '{}' follows a painting (one with model: painted and from: "
                    "{{painting: FILE.png}} does)",
                    show.file));
  }
  const std::string list = fmt::format("{}", fmt::join(paintings, ", "));
  if (!word.empty()) {
    return input_error(fmt::format("section {} follows no painting (these do: {})", config::in_quotes(word), list));
  }
  if (paintings.size() > 1) return input_error(fmt::format("name one of the show's paintings: {}", list));
  return *last;
}

Result<FormationIndex> find_formation(const Plan& plan, const std::string& word) {
  std::vector<std::string> known;
  for (std::size_t k = 0; k < plan.formations.size(); ++k) {
    if (plan.formations[k].id == word) return FormationIndex::of(k);
    known.push_back(plan.formations[k].id);
  }
  return input_error(fmt::format("there is no formation {} ({})", config::in_quotes(word),
                                 config::suggestion(word, known, "formations")));
}

}  // namespace footlight::app
