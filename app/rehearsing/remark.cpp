// SPDX-License-Identifier: Apache-2.0
#include "app/rehearsing/remark.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

#include <fmt/format.h>

#include "core/grid.hpp"

namespace footlight::app {
namespace {

using About = Remark::About;

constexpr std::array<std::string_view, 4> kAbout{"all", "person", "group", "cell"};

bool same(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

std::string joined(const std::vector<std::string>& words, std::size_t from, std::size_t to) {
  std::string out;
  for (std::size_t i = from; i < to; ++i) out += (i > from ? " " : "") + words[i];
  return out;
}

/// What is called so, among what is asked for.
std::vector<Remark> called(const Show& show, const std::string& name, std::optional<About> only) {
  std::vector<Remark> found;
  const auto wanted = [&](About about) { return !only || *only == about; };
  if (wanted(About::person)) {
    for (const Performer& performer : show.performers) {
      if (!same(performer.id, name) && !same(performer.name, name)) continue;
      found.push_back({About::person, performer.name, {}});
      break;  // ids are unique, and of people with one name the first is as good as any
    }
  }
  if (wanted(About::group)) {
    for (const Group& group : show.groups) {
      if (same(group.name, name)) found.push_back({About::group, group.name, {}});
    }
  }
  if (wanted(About::cell)) {
    const auto cell = parse_cell(name);
    if (cell && show.stage.grid.contains(*cell)) found.push_back({About::cell, cell_name(*cell), {}});
  }
  return found;
}

/// The longest beginning of `words`, from `first` on, that is a name.
Result<std::optional<Remark>> find(const Show& show, const std::vector<std::string>& words, std::size_t first,
                                   std::optional<About> only) {
  for (std::size_t to = words.size(); to > first; --to) {
    const std::string name = joined(words, first, to);
    std::vector<Remark> found = called(show, name, only);
    if (found.empty()) continue;
    if (found.size() > 1) {
      return input_error(fmt::format("note: \"{0}\" is a {1} and a {2} (\"note {1} {0} ...\" or \"note {2} {0} ...\")",
                                     name, to_text(found[0].about), to_text(found[1].about)));
    }
    found[0].text = joined(words, to, words.size());
    return std::optional(found[0]);
  }
  return std::optional<Remark>();
}

}  // namespace

std::string_view to_text(Remark::About about) { return kAbout.at(static_cast<std::size_t>(about)); }

Result<Remark> read_remark(const Show& show, const std::vector<std::string>& words) {
  const Error nothing = input_error("note: what is to be said? As in \"note Ana too late\", \"note all smile\"");
  if (words.empty()) return nothing;
  const auto kind = std::ranges::find_if(kAbout, [&](std::string_view word) { return same(word, words[0]); });
  Remark remark{About::all, {}, joined(words, 0, words.size())};
  if (kind != kAbout.end()) {
    const auto about = static_cast<About>(kind - kAbout.begin());
    remark.text = joined(words, 1, words.size());
    if (about != About::all) {
      auto found = find(show, words, 1, about);
      if (!found) return std::move(found).error();
      if (!*found) {
        return input_error(
            fmt::format("note: there is no {} \"{}\"", to_text(about), words.size() > 1 ? words[1] : ""));
      }
      remark = **found;
    }
  } else {
    auto found = find(show, words, 0, std::nullopt);
    if (!found) return std::move(found).error();
    if (*found) remark = **found;
  }
  if (remark.text.empty()) return nothing;
  return remark;
}

}  // namespace footlight::app
