// SPDX-License-Identifier: Apache-2.0
#include "controller/cue_schedule.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "controller/bus_budget.hpp"
#include "controller/crowd.hpp"
#include "controller/cue_list.hpp"
#include "controller/lamp.hpp"
#include "controller/look_book.hpp"
#include "controller/patterns.hpp"
#include "controller/plan_check.hpp"
#include "core/check.hpp"
#include "core/diagnostic.hpp"
#include "core/patch.hpp"

namespace footlight::controller {

namespace {
constexpr std::size_t kMostLooks = 254;
constexpr double kNearPitches = 1.5;

struct LampAt {
  CellIndex cell;
  std::size_t slot = 0;  ///< node x 32 + channel
};

constexpr std::uint16_t kDarkEntry = std::numeric_limits<std::uint16_t>::max();

/// Follows the crowd twice: first to see whose goals are near each other, then to light the lamps.
class Compiler {
 public:
  Compiler(const Show& show, const Plan& plan, const Rig& rig, const std::vector<CuePlay>& plays)
      : show_file_(show.file),
        tempo_(show.tempo),
        plan_(plan),
        crowd_(show, plan, plays),
        book_(show, plan.tracks.size()),
        nodes_(rig.nodes.size()),
        worn_(worn_in(rig)) {
    lit_.resize(static_cast<std::size_t>(plan.stage.grid.size()));
    for (std::size_t n = 0; n < rig.nodes.size(); ++n) {
      for (std::size_t c = 0; c < rig.nodes[n].channels.size(); ++c) {
        const Channel& channel = rig.nodes[n].channels[c];
        const std::size_t slot = n * kChannelsPerNode + c;
        if (channel.kind == Channel::Kind::cell) {
          lamps_.push_back({channel.cell, slot});
          lit_[channel.cell.at()] = true;
        }
      }
    }
    for (std::size_t c = 0; c < lit_.size(); ++c) near_.push_back(near(CellIndex::of(c)));
  }

  Result<CueSchedule> compile() {
    int patterns = kPatterns;
    while (patterns > 1 && book_.different(patterns) + 1 > kMostLooks) patterns /= 2;
    if (book_.different(patterns) + 1 > kMostLooks) {
      Diagnostic diagnostic;
      diagnostic.position.file = show_file_;
      diagnostic.key_path = "performers.groups";
      diagnostic.text = "the groups' colours need " + std::to_string(book_.different(patterns) + 1) +
                        " looks and a marker's look table holds 254";
      diagnostic.hint =
          "give groups that never stand side by side the same colour, or give looks a colour of their own";
      return input_error(to_text(diagnostic));
    }
    NearGoals near(plan_.tracks.size());
    for (std::size_t k = 0; k < crowd_.moments().size(); ++k) {
      light(k);
      for_near_goals([&](const Lamp& a, const Lamp& b) {
        if (a.whose < b.whose && book_.look(book_.entry(a, 0)) == book_.look(book_.entry(b, 0)))
          near.add(a.whose, b.whose);
      });
    }
    pattern_ = near.patterns(patterns);
    return number(write());
  }

  /// With the numbers of another schedule, for lamps that are lit beside it.
  ResetMove compile_like(const CueSchedule& schedule, bool stand) {
    pattern_ = schedule.numbers().pattern;
    const Written written = write();
    ResetMove move;
    for (const std::uint16_t entry : written.entries) move.table.push_back(number_like(schedule.numbers(), entry));
    move.switches = switches();
    move.contents = std::move(contents_.table);
    if (stand) return move;
    // Here people stand already: the show's own lamps say so.
    const auto row = static_cast<std::ptrdiff_t>(nodes_ * kChannelsPerNode);
    move.switches.erase(move.switches.begin());
    move.table.erase(move.table.begin(), move.table.begin() + row);
    move.contents.erase(move.contents.begin(), move.contents.begin() + static_cast<std::ptrdiff_t>(worn_.size()));
    return move;
  }

  /// @param muted of each performer
  MutedLamps compile_muted(const CueSchedule& schedule, const std::vector<bool>& muted) {
    pattern_ = schedule.numbers().pattern;
    const LookIndex quiet = schedule.numbers().quiet;
    const std::size_t row = nodes_ * kChannelsPerNode;
    MutedLamps out;
    out.table.reserve(crowd_.moments().size() * row);
    std::vector<CellUse> concerned;
    for (std::size_t k = 0; k < crowd_.moments().size(); ++k) {
      light(k);
      uses_of(doing_, lit_.size(), concerned, muted);
      const std::vector<bool>& reserve = crowd_.reserve_at(k);
      for (std::size_t n = 0; n < nodes_; ++n) {
        const auto looks = schedule.looks_of(k, NodeIndex::of(n));
        out.table.insert(out.table.end(), looks.begin(), looks.end());
      }
      LookIndex* const here = out.table.data() + k * row;
      for (const LampAt& lamp : lamps_) {
        const Lamp& all = lamp_[lamp.cell.at()];
        const Lamp own = lamp_of(concerned[lamp.cell.at()], reserve[lamp.cell.at()]);
        // What is as it was keeps its number, also one that a supply has dimmed.
        if (own == all) continue;
        here[lamp.slot] = own.role ? number_like(schedule.numbers(), entry(own)) : quiet;
      }
      for (std::size_t w = 0; w < worn_.size(); ++w) {
        const bool is_muted = muted[worn_[w].performer.at()];
        LookIndex& look = here[worn_[w].node.at() * kChannelsPerNode + static_cast<std::size_t>(worn_[w].channel)];
        if (is_muted && look != kDark) look = quiet;
        out.contents.push_back(is_muted ? drivers::WearableContent{} : schedule.content(k, w));
      }
    }
    return out;
  }

 private:
  [[nodiscard]] std::vector<CellIndex> near(CellIndex cell) const {
    std::vector<CellIndex> list;
    if (!lit_[cell.at()]) return list;
    const Grid& grid = plan_.stage.grid;
    // Centres lie on a lattice: a hundredth of a pitch keeps rounding from deciding.
    for (const CellIndex other : grid.within(grid.centre(cell), (kNearPitches + 0.01) * grid.pitch_m())) {
      if (other != cell && lit_[other.at()]) list.push_back(other);
    }
    return list;
  }

  void light(std::size_t k) {
    crowd_.look_at(k, doing_);
    uses_of(doing_, lit_.size(), uses_);
    const std::vector<bool>& reserve = crowd_.reserve_at(k);
    lamp_.resize(lit_.size());
    for (std::size_t c = 0; c < lit_.size(); ++c) lamp_[c] = lamp_of(uses_[c], reserve[c]);
  }

  /// Both orders of each pair of lamps that are goals of two people within 1.5 pitches.
  template <class Visit>
  void for_near_goals(Visit visit) const {
    for (const LampAt& lamp : lamps_) {
      const Lamp& own = lamp_[lamp.cell.at()];
      if (!is_goal(own)) continue;
      for (const CellIndex cell : near_[lamp.cell.at()]) {
        const Lamp& other = lamp_[cell.at()];
        if (is_goal(other) && other.whose != own.whose) visit(own, other);
      }
    }
  }

  [[nodiscard]] std::uint16_t entry(const Lamp& lamp) const {
    if (!lamp.role) return kDarkEntry;
    const std::uint16_t entry = book_.entry(lamp, pattern_[lamp.whose.at()]);
    return book_.look(entry).brightness == 0 ? kDarkEntry : entry;
  }

  /// A book's entry for every switch and channel, and which entries are used.
  struct Written {
    std::vector<std::uint16_t> entries;
    std::vector<bool> used;
    LampConfusion confusion;
  };

  Written write() {
    const std::size_t row = nodes_ * kChannelsPerNode;
    contents_.worn = worn_;
    std::vector<std::uint16_t> entries(crowd_.moments().size() * row, kDarkEntry);
    std::vector<bool> used(book_.size(), false);
    LampConfusion confusion;
    for (std::size_t k = 0; k < crowd_.moments().size(); ++k) {
      light(k);
      const auto put = [&](std::size_t slot, const Lamp& lamp) {
        const std::uint16_t e = entry(lamp);
        entries[k * row + slot] = e;
        if (e != kDarkEntry) used[e] = true;
      };
      for (const LampAt& lamp : lamps_) put(lamp.slot, lamp_[lamp.cell.at()]);
      const std::vector<bool>& reserve = crowd_.reserve_at(k);
      for (const WearableContents::Worn& worn : worn_) {
        const Doing& doing = doing_[worn.performer.at()];
        put(worn.node.at() * kChannelsPerNode + static_cast<std::size_t>(worn.channel),
            wearable_of(worn.performer, doing, reserve[doing.cell.at()]));
        contents_.table.push_back(content_of(doing, plan_.tracks[worn.performer.at()], plan_.stage.grid, tempo_));
      }
      for_near_goals([&](const Lamp& a, const Lamp& b) {
        confusion.before += book_.look(book_.entry(a, 0)) == book_.look(book_.entry(b, 0)) ? 1 : 0;
        const std::uint16_t look_a = entry(a);
        const std::uint16_t look_b = entry(b);
        if (look_a == kDarkEntry || look_b == kDarkEntry) return;
        confusion.after += book_.look(look_a) == book_.look(look_b) ? 1 : 0;
      });
    }
    return {std::move(entries), std::move(used), confusion};
  }

  static LookIndex number_like(const LookNumbers& numbers, std::uint16_t entry) {
    if (entry == kDarkEntry) return kDark;
    for (const std::uint16_t like : LookBook::like(entry)) {
      if (numbers.of_entry[like] != kDark) return numbers.of_entry[like];
    }
    for (const LookIndex any : numbers.of_entry) {
      if (any != kDark) return any;
    }
    return kDark;
  }

  [[nodiscard]] std::vector<Switch> switches() const {
    std::vector<Switch> switches;
    for (const Moment& moment : crowd_.moments())
      switches.push_back({moment.time, moment.cause, moment.settled, moment.cue});
    return switches;
  }

  Result<CueSchedule> number(const Written& written) {
    const auto& [entries, used, confusion] = written;
    std::vector<Look> looks;
    for (std::size_t e = 0; e < used.size(); ++e) {
      if (used[e]) looks.push_back(book_.look(static_cast<std::uint16_t>(e)));
    }
    std::sort(looks.begin(), looks.end());
    looks.erase(std::unique(looks.begin(), looks.end()), looks.end());
    looks.insert(looks.begin(), Look{{0, 0, 0}, Effect::steady, 0});
    std::vector<LookIndex> number_of(used.size(), kDark);
    for (std::size_t e = 0; e < used.size(); ++e) {
      if (!used[e]) continue;
      const auto found = std::lower_bound(looks.begin() + 1, looks.end(), book_.look(static_cast<std::uint16_t>(e)));
      number_of[e] = static_cast<LookIndex>(found - looks.begin());
    }
    std::vector<LookIndex> table(entries.size(), kDark);
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if (entries[i] != kDarkEntry) table[i] = number_of[entries[i]];
    }
    CueSchedule schedule(std::move(looks), switches(), nodes_, std::move(table), plan_byte_of(plan_), confusion);
    schedule.set_contents(std::move(contents_));
    schedule.set_numbers({pattern_, std::move(number_of)});
    return schedule;
  }

  const std::string& show_file_;
  const TempoMap& tempo_;
  const Plan& plan_;
  Crowd crowd_;
  LookBook book_;
  std::size_t nodes_;
  std::vector<WearableContents::Worn> worn_;
  WearableContents contents_;
  std::vector<LampAt> lamps_;
  std::vector<bool> lit_;                     ///< cells that have a lamp
  std::vector<std::vector<CellIndex>> near_;  ///< of each cell: other lit cells within 1.5 pitches
  std::vector<std::uint8_t> pattern_;         ///< of each performer
  // The moment under the hand.
  std::vector<Doing> doing_;
  std::vector<CellUse> uses_;
  std::vector<Lamp> lamp_;  ///< of each cell
};

}  // namespace

CueSchedule::CueSchedule(std::vector<Look> looks, std::vector<Switch> switches, std::size_t nodes,
                         std::vector<LookIndex> table, std::uint8_t plan_byte, LampConfusion confusion)
    : looks_(std::move(looks)),
      switches_(std::move(switches)),
      nodes_(nodes),
      table_(std::move(table)),
      plan_byte_(plan_byte),
      confusion_(confusion) {
  FL_CHECK(!switches_.empty() && !looks_.empty() && looks_.size() <= kMostLooks);
  FL_CHECK(table_.size() == switches_.size() * nodes_ * kChannelsPerNode);
}

void CueSchedule::set_contents(WearableContents contents) {
  FL_CHECK(contents.table.size() == contents.worn.size() * switches_.size());
  contents_ = std::move(contents);
}

void CueSchedule::renumber(std::vector<Look> looks, std::span<const LookIndex> now, std::uint8_t plan_byte) {
  FL_CHECK(resets_->count.load() == 0 && muted_->count.load() == 0);
  FL_CHECK(looks.size() <= kMostLooks && now.size() == looks_.size() && now[0] == kDark);
  looks_ = std::move(looks);
  plan_byte_ = plan_byte;
  for (LookIndex& look : table_) look = now[look];
  for (LookIndex& look : numbers_.of_entry) look = now[look];
  numbers_.quiet = now[numbers_.quiet];
}

std::vector<bool> CueSchedule::numbers_shown() const {
  std::vector<bool> shown(looks_.size(), false);
  for (const LookIndex look : table_) shown[look] = true;
  for (const LookIndex look : numbers_.of_entry) shown[look] = true;
  shown[numbers_.quiet] = true;
  return shown;
}

bool CueSchedule::has(std::size_t k) const {
  if (k < switches_.size()) return true;
  const std::size_t slot = (k - switches_.size()) / kMostResetSwitches;
  if (slot >= resets_->count.load(std::memory_order_acquire)) return false;
  return (k - switches_.size()) % kMostResetSwitches < resets_->moves[slot]->switches.size();
}

void CueSchedule::add_quiet(std::size_t most) {
  if (looks_.size() >= kMostLooks || looks_.size() > most) return;
  numbers_.quiet = static_cast<LookIndex>(looks_.size());
  looks_.push_back(kQuiet);
}

bool CueSchedule::is_muted_set(std::size_t first) const {
  if (first < first_muted() || (first - first_muted()) % muted_stride() != 0) return false;
  return (first - first_muted()) / muted_stride() < muted_->count.load(std::memory_order_acquire);
}

const MutedLamps& CueSchedule::muted_of(std::size_t k) const {
  const std::size_t slot = (k - first_muted()) / muted_stride();
  FL_CHECK(slot < muted_->count.load(std::memory_order_acquire));
  return *muted_->lamps[slot];
}

std::optional<std::size_t> CueSchedule::add(MutedLamps lamps) {
  const std::size_t slot = muted_->count.load(std::memory_order_relaxed);
  if (slot == kMostMuted) return std::nullopt;
  FL_CHECK(lamps.table.size() == table_.size() && lamps.contents.size() == contents_.table.size());
  muted_->lamps[slot] = std::make_unique<const MutedLamps>(std::move(lamps));
  muted_->count.store(slot + 1, std::memory_order_release);
  return first_muted() + slot * muted_stride();
}

const ResetMove& CueSchedule::reset_of(std::size_t k) const {
  const std::size_t slot = (k - switches_.size()) / kMostResetSwitches;
  FL_CHECK(slot < resets_->count.load(std::memory_order_acquire));
  return *resets_->moves[slot];
}

std::optional<std::size_t> CueSchedule::add(ResetMove move) {
  const std::size_t slot = resets_->count.load(std::memory_order_relaxed);
  const std::size_t rows = move.switches.size();
  if (slot == kMostResets || rows > kMostResetSwitches) return std::nullopt;
  FL_CHECK(move.table.size() == rows * nodes_ * kChannelsPerNode);
  FL_CHECK(move.contents.size() == rows * contents_.worn.size());
  resets_->moves[slot] = std::make_unique<const ResetMove>(std::move(move));
  resets_->count.store(slot + 1, std::memory_order_release);
  return switches_.size() + slot * kMostResetSwitches;
}

std::span<const LookIndex> CueSchedule::looks_of(std::size_t k, NodeIndex node) const {
  FL_CHECK(node.at() < nodes_);
  const bool own = k < switches_.size();
  const bool muted = k >= first_muted();
  const std::size_t row = own ? k : muted ? plain(k) : (k - switches_.size()) % kMostResetSwitches;
  const std::span<const LookIndex> table(own ? table_ : muted ? muted_of(k).table : reset_of(k).table);
  FL_CHECK((row + 1) * nodes_ * kChannelsPerNode <= table.size());
  return table.subspan((row * nodes_ + node.at()) * kChannelsPerNode, kChannelsPerNode);
}

const drivers::WearableContent& CueSchedule::content(std::size_t k, std::size_t w) const {
  if (k < switches_.size()) return contents_.at(k, w);
  if (k >= first_muted()) return muted_of(k).contents.at(plain(k) * contents_.worn.size() + w);
  return reset_of(k).contents.at((k - switches_.size()) % kMostResetSwitches * contents_.worn.size() + w);
}

Result<CueSchedule> build_schedule(const Show& show, const Plan& plan, const Rig& rig,
                                   const std::vector<std::unique_ptr<drivers::Driver>>& drivers) {
  FL_CHECK(drivers.size() == rig.buses.size());
  if (!plan.valid) {
    return refusal("the plan of \"" + plan.title +
                   "\" is not valid and never lights a marker (footlight plan says what is wrong with it)");
  }
  const std::vector<CuePlay> plays = cue_plays(show, plan);
  Result<CueSchedule> schedule = Compiler(show, plan, rig, plays).compile();
  if (!schedule) return schedule;
  schedule = within_supplies(std::move(schedule).value(), rig, drivers, plays);
  if (!schedule) return schedule;
  for (std::size_t b = 0; b < drivers.size(); ++b) {
    const int most = drivers[b]->capabilities().looks;
    const auto wanted = static_cast<int>(schedule->looks().size()) - 1;
    if (wanted <= most) continue;
    return refusal("bus \"" + rig.buses[b].name + "\": its devices know " + std::to_string(most) +
                   " looks besides dark, and the show has " + std::to_string(wanted) +
                   " (fewer groups' colours, or looks with colours of their own)");
  }
  std::vector<Duration> gaps;
  for (const CuePlay& play : plays) gaps.push_back(play.gap_after.value_or(kShortestHold));
  const std::vector<BusNeed> needs = bus_needs(*schedule, rig, drivers, gaps);
  if (!std::ranges::all_of(needs, &BusNeed::fits)) return over_budget(needs, *schedule, rig, show);
  WantedChecks checks{plan_check_of(plan)};
  for (const Node& node : rig.nodes) checks.patches.push_back(patch_check(node));
  schedule->set_checks(std::move(checks));
  return schedule;
}

MutedLamps build_muted(const Show& show, const Plan& plan, const Rig& rig, const CueSchedule& schedule,
                       const std::vector<bool>& muted) {
  FL_CHECK(schedule.numbers().quiet != kDark && muted.size() == show.groups.size() + 1);
  std::vector<bool> people(plan.tracks.size());
  for (std::size_t p = 0; p < people.size(); ++p) {
    const auto group = p < show.performers.size() ? show.performers[p].group : std::nullopt;
    people[p] = muted[group ? group->at() : show.groups.size()];
  }
  return Compiler(show, plan, rig, cue_plays(show, plan)).compile_muted(schedule, people);
}

ResetMove build_reset(const Show& show, const Plan& move, const Rig& rig, const CueSchedule& schedule, bool stand) {
  FL_CHECK(move.valid && schedule.numbers().pattern.size() == move.tracks.size());
  return Compiler(show, move, rig, {}).compile_like(schedule, stand);
}

}  // namespace footlight::controller
