// SPDX-License-Identifier: Apache-2.0
#include "app/rehearsing/mute_orders.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

#include <fmt/format.h>

namespace footlight::app {
namespace {

constexpr std::string_view kNobodys = "no group";

bool same(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

/// "kids , brass band" to "kids", "brass band".
std::vector<std::string> names_in(const std::vector<std::string>& words) {
  std::vector<std::string> names(1);
  for (const std::string& word : words) {
    if (!names.back().empty()) names.back() += ' ';
    for (const char c : word) {
      if (c == ',') {
        names.emplace_back();
      } else {
        names.back() += c;
      }
    }
  }
  for (std::string& name : names) {
    while (name.ends_with(' ')) name.pop_back();
  }
  std::erase(names, "");
  return names;
}

}  // namespace

void MuteOrders::add_to(RunDesk& desk) {
  desk.add(*this);
  desk.add([this](DeskView& view) { view.muted = names(); });
  const auto words_of = [](auto carry_out) {
    return [carry_out](const std::vector<std::string>& words, const Speaker& /*who*/) { return carry_out(words); };
  };
  desk.add(RunDesk::Verb{"solo",
                         "solo trumpets; solo off      only they are guided, other lamps are quiet; everybody again\n",
                         words_of([this](const auto& words) { return solo(words); })});
  desk.add(RunDesk::Verb{"mute", "mute kids, tubas             they are not guided; also: mute no group\n",
                         words_of([this](const auto& words) { return mute(words, true); })});
  desk.add(RunDesk::Verb{"unmute", "unmute kids; unmute          they are again; everybody is\n",
                         words_of([this](const auto& words) { return mute(words, false); })});
}

void MuteOrders::look(const DeskView& view, RunDesk& desk) {
  possible_ = view.schedule != nullptr && view.schedule->numbers().quiet != kDark;
  if (std::exchange(wanted_, false)) desk.mute(muted_);
}

void MuteOrders::plan_taken() {
  if (muted_.size() != show_.groups.size() + 1) muted_.assign(show_.groups.size() + 1, false);
}

Result<std::vector<std::size_t>> MuteOrders::groups_in(std::string_view verb,
                                                       const std::vector<std::string>& words) const {
  std::vector<std::size_t> found;
  std::string all;
  for (const Group& group : show_.groups) all += (all.empty() ? "" : ", ") + group.name;
  if (show_.groups.empty()) return input_error(fmt::format("{}: this show has no groups", verb));
  if (!possible_) {
    return input_error(fmt::format("{}: no marker has room for the look of people who are muted", verb));
  }
  for (const std::string& name : names_in(words)) {
    const auto group = std::ranges::find_if(show_.groups, [&](const Group& one) { return same(one.name, name); });
    if (group == show_.groups.end() && !same(name, kNobodys)) {
      return input_error(fmt::format("{}: no group \"{}\" (there are {}; \"{}\")", verb, name, all, kNobodys));
    }
    found.push_back(static_cast<std::size_t>(group - show_.groups.begin()));
  }
  if (found.empty())
    return input_error(fmt::format("{0}: a group is wanted, as in \"{0} {1}\"", verb, show_.groups[0].name));
  return found;
}

Result<std::string> MuteOrders::solo(const std::vector<std::string>& words) {
  if (words.size() == 1 && same(words[0], "off")) {
    muted_.assign(muted_.size(), false);
    return changed();
  }
  const auto groups = groups_in("solo", words);
  if (!groups) return groups.error();
  muted_.assign(muted_.size(), true);
  for (const std::size_t group : *groups) muted_[group] = false;
  return changed();
}

Result<std::string> MuteOrders::mute(const std::vector<std::string>& words, bool muted) {
  if (!muted && words.empty()) {
    muted_.assign(muted_.size(), false);
    return changed();
  }
  const auto groups = groups_in(muted ? "mute" : "unmute", words);
  if (!groups) return groups.error();
  for (const std::size_t group : *groups) muted_[group] = muted;
  return changed();
}

std::string MuteOrders::changed() {
  wanted_ = true;
  const std::string who = names();
  return who.empty() ? "everybody is guided" : "not guided: " + who;
}

std::string MuteOrders::names() const {
  std::string out;
  for (std::size_t i = 0; i < muted_.size(); ++i) {
    if (!muted_[i]) continue;
    // Those in no group are worth a word only where there are some.
    if (i == show_.groups.size() &&
        std::ranges::all_of(show_.performers, [](const Performer& p) { return p.group.has_value(); }))
      continue;
    out += (out.empty() ? "" : ", ") +
           (i < show_.groups.size() ? show_.groups[i].name : "those in " + std::string(kNobodys));
  }
  return out;
}

}  // namespace footlight::app
