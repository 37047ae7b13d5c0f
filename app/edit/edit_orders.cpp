// SPDX-License-Identifier: Apache-2.0
// What is said to ShowEditing. What comes of it: show_editing.cpp.
#include <algorithm>

#include <fmt/format.h>

#include "app/edit/show_editing.hpp"
#include "app/find_in_show.hpp"
#include "app/natural_order.hpp"
#include "config/nearest.hpp"

namespace footlight::app {
namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : " ") + word;
  return out;
}

std::string list_of(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

}  // namespace

void ShowEditing::add_orders(RunDesk& desk) {
  const auto add = [&](const char* word, const char* help, auto carry_out) {
    desk.add({word, help, [carry_out](const Words& words, const Speaker&) { return carry_out(words); }});
  };
  add("take", "take; discard                what has changed, where the show stands next; take placed: no reset move\n",
      [this](const Words& words) { return take(words); });
  add("discard", "", [this](const Words&) { return discard(); });
  add("absent", "absent 7; present 7          she does not come, and nobody else has to do anything yet; she does\n",
      [this](const Words& words) { return absent(words); });
  add("present", "", [this](const Words& words) { return present(words); });
  add("cover", "cover 7 by zoe; cover 7      zoe takes the whole way of 7 and her wearable; her understudy does\n",
      [this](const Words& words) { return cover(words); });
  add("repair", "repair 7                     the planner finds whoever changes least\n",
      [this](const Words& words) { return repair(words); });
  add("changed", "changed; told 7; told all    whose walks have changed and who has not been told\n",
      [this](const Words&) { return list_changed(); });
  add("told", "", [this](const Words& words) { return tick(words); });
}

// ---- edits

Result<std::string> ShowEditing::take(const Words& words) {
  const bool placed = words.size() == 1 && words[0] == "placed";
  if (!words.empty() && !placed) return input_error("take: alone, or \"take placed\" where people stand already");
  if (handing_over_) return input_error("take: it is being taken");
  if (!coming_ || again_) {
    return input_error(work_.valid() || again_ ? "take: it is still being planned"
                       : !error_.empty()       ? "take: what has changed is wrong, and nothing is changed by it"
                                               : "take: nothing has changed");
  }
  take_ = true;
  placed_ = placed;
  return std::string("where the show stands next and everybody is on a cell (hold end)");
}

Result<std::string> ShowEditing::discard() {
  if (handing_over_) return input_error("discard: it is being taken");
  if (!coming_ && error_.empty() && !work_.valid() && !again_) return input_error("discard: nothing has changed");
  given_up_.store(true);
  again_ = false;
  if (work_.valid()) {
    work_.wait();  // a killed process ends at once
    work_ = {};
  }
  drop_coming();
  error_.clear();
  forget_wishes();
  return std::string("what plays stays as it is");
}

// ---- who does not come

Result<std::string> ShowEditing::person(const Words& words) const {
  const std::string who = joined(words);
  if (who.empty()) return input_error("who? An id or a name is wanted, as in \"absent 7\"");
  const auto found = find_performer(everybody_, who);
  if (!found) return found.error();
  return everybody_.performers[found->at()].id;
}

Result<std::string> ShowEditing::absent(const Words& words) {
  const auto id = person(words);
  if (!id) return id.error();
  if (!wanted_.absent.insert(*id).second) return input_error(fmt::format("{} is absent already", *id));
  std::string by;
  for (const Understudy& one : everybody_.understudies) {
    const auto covers = [&](PerformerIndex p) { return everybody_.performers[p.at()].id == *id; };
    if (std::ranges::any_of(one.covers, covers)) by += fmt::format(", or cover {} by {}", *id, one.id);
  }
  return fmt::format("{} is absent; her place stays empty until somebody says repair {}{}", *id, *id, by);
}

Result<std::string> ShowEditing::present(const Words& words) {
  const auto id = person(words);
  if (!id) return id.error();
  if (wanted_.absent.erase(*id) == 0) return input_error(fmt::format("{} is not absent", *id));
  const bool planned = wanted_.covers.erase(*id) + wanted_.repaired.erase(*id) > 0;
  if (planned) plan_again(*id + " is here again");
  return std::string(planned ? "being planned: the way is her own again" : "done");
}

Result<std::string> ShowEditing::standing_by(const std::string& absent, const Words& words) const {
  const std::string who = joined(words);
  std::vector<std::string> known;
  for (const Understudy& one : everybody_.understudies) {
    if (one.id == who || one.name == who) return one.id;
    const auto covers = [&](PerformerIndex p) { return everybody_.performers[p.at()].id == absent; };
    if (who.empty() && std::ranges::any_of(one.covers, covers)) return one.id;
    known.insert(known.end(), {one.id, one.name});
  }
  if (who.empty()) {
    return input_error(
        fmt::format("cover: nobody has learned the way of {0} (cover {0} by somebody, or repair {0})", absent));
  }
  const auto found = find_performer(everybody_, who);
  if (found) return everybody_.performers[found->at()].id;
  for (const Performer& one : everybody_.performers) known.insert(known.end(), {one.id, one.name});
  return input_error(fmt::format("cover: there is nobody called {} ({})", config::in_quotes(who),
                                 config::suggestion(who, known, "people")));
}

Result<std::string> ShowEditing::cover(const Words& words) {
  const auto by = std::ranges::find(words, "by");
  const auto id = person(Words(words.begin(), by));
  if (!id) return id.error();
  const auto taker = standing_by(*id, by == words.end() ? Words() : Words(by + 1, words.end()));
  if (!taker) return taker.error();
  if (*taker == *id) return input_error("cover: nobody covers herself");
  if (wanted_.absent.contains(*taker)) return input_error(fmt::format("cover: {} is absent", *taker));
  for (const auto& [absent, cover] : wanted_.covers) {
    if (cover == *taker && absent != *id) return input_error(fmt::format("cover: {} covers {} already", cover, absent));
  }
  wanted_.absent.insert(*id);
  wanted_.repaired.erase(*id);
  wanted_.covers[*id] = *taker;
  plan_again(fmt::format("{} covers {}", *taker, *id));
  return std::string("being planned");
}

Result<std::string> ShowEditing::repair(const Words& words) {
  const auto id = person(words);
  if (!id) return id.error();
  wanted_.absent.insert(*id);
  wanted_.covers.erase(*id);
  wanted_.repaired.insert(*id);
  plan_again(*id + " is absent: the fewest changes");
  return std::string("being planned");
}

// ---- who has to be told

Result<std::string> ShowEditing::list_changed() const {
  if (told_.size() == 0) return std::string("nobody has to be told anything");
  return fmt::format("{} to be told: {}", told_.size(), list_of(*told_.people()));
}

Result<std::string> ShowEditing::tick(const Words& words) {
  if (words.size() == 1 && words[0] == "all") {
    keep(told_.tick_all());
    return std::string("everybody has been told");
  }
  const std::string who = joined(words);
  std::string id = who;
  for (const Understudy& one : everybody_.understudies) {
    if (one.name == who) id = one.id;
  }
  if (!told_.contains(id)) {
    const auto found = person(words);
    if (!found) return found.error();
    id = *found;
  }
  if (!told_.contains(id)) return input_error(fmt::format("told: {} has nothing to be told", id));
  keep(told_.tick(id));
  return fmt::format("{}, {} to be told", id, told_.size());
}

}  // namespace footlight::app
