// SPDX-License-Identifier: Apache-2.0
#include "controller/supply_load.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "controller/cue_list.hpp"
#include "controller/cue_schedule.hpp"
#include "core/check.hpp"
#include "core/diagnostic.hpp"

namespace footlight::controller {
namespace {

constexpr std::size_t kShownSupplies = 10;
constexpr std::size_t kMostLooks = 254;
constexpr int kLeastBrightness = 13;  // a twentieth: still seen at one's feet on a dark stage
constexpr int kRounds = 16;           // of dimming; each comes nearer
constexpr double kRounding_a = 1e-9;
constexpr std::size_t kNone = static_cast<std::size_t>(-1);

using Drivers = std::vector<std::unique_ptr<drivers::Driver>>;
using Cue = std::optional<std::size_t>;

Look dimmed(Look look, double factor) {
  const int scaled = static_cast<int>(std::floor(look.brightness * factor));
  look.brightness = static_cast<std::uint8_t>(std::max(scaled, std::min<int>(look.brightness, kLeastBrightness)));
  return look;
}

/// Lamps of the rig by their supplies, and what each look takes there.
class Accounts {
 public:
  Accounts(const CueSchedule& schedule, const Rig& rig, const Drivers& drivers)
      : schedule_(schedule), rig_(rig), drivers_(drivers), supply_of_(supplies_of(rig)) {
    nodes_of_.resize(rig.supplies.size());
    for (std::size_t n = 0; n < supply_of_.size(); ++n) {
      if (supply_of_[n] != kNone) nodes_of_[supply_of_[n]].push_back(n);
    }
  }

  /// Of every node: its supply, or kNone.
  static std::vector<std::size_t> supplies_of(const Rig& rig) {
    std::vector<std::size_t> out(rig.nodes.size(), kNone);
    for (std::size_t n = 0; n < rig.nodes.size(); ++n) {
      for (std::size_t s = 0; s < rig.supplies.size(); ++s) {
        if (!rig.nodes[n].supply.empty() && rig.supplies[s].name == rig.nodes[n].supply) out[n] = s;
      }
    }
    return out;
  }

  [[nodiscard]] const std::vector<std::size_t>& nodes_of(std::size_t supply) const { return nodes_of_[supply]; }

  /// Nodes and lamps, and what does not depend on the show.
  [[nodiscard]] SupplyLoad standing(std::size_t supply) const {
    SupplyLoad load;
    load.supply = supply;
    for (const std::size_t n : nodes_of_[supply]) {
      const Node& node = rig_.nodes[n];
      const LampCurrents& currents = currents_of(node);
      const auto lamps = static_cast<int>(std::ranges::count_if(
          node.channels, [](const Channel& channel) { return channel.kind != Channel::Kind::unused; }));
      ++load.nodes;
      load.lamps += lamps;
      load.dark_a += currents.node_a;
      load.unguided_a += lamps * lamp_current(drivers_[node.bus.at()]->unguided(), currents);
    }
    load.unguided_a += load.dark_a;
    return load;
  }

  /// Into the lamps of a supply from switch `k` on, every look dimmed by `factor`; peak and mean.
  [[nodiscard]] std::pair<double, double> lamps_at(std::size_t supply, std::size_t k, double factor) {
    double peak_a = 0;
    double mean_a = 0;
    for (const std::size_t n : nodes_of_[supply]) {
      const Node& node = rig_.nodes[n];
      const std::vector<double>& table = table_of(node.bus.at(), factor);
      const auto looks = schedule_.looks_of(k, NodeIndex::of(n)).first(node.channels.size());
      for (const LookIndex look : looks) {
        peak_a += table[look];
        mean_a += table[look] * mean_share(schedule_.looks()[look].effect);
      }
    }
    return {peak_a, mean_a};
  }

 private:
  [[nodiscard]] const LampCurrents& currents_of(const Node& node) const {
    return rig_.currents_of(rig_.buses[node.bus.at()]);
  }
  /// What each look of the schedule takes in a lamp of this bus.
  const std::vector<double>& table_of(std::size_t bus, double factor) {
    std::vector<double>& table = tables_[{bus, factor}];
    if (!table.empty()) return table;
    for (const Look& look : schedule_.looks()) {
      const Look shown = drivers_[bus]->shown(factor < 1 ? dimmed(look, factor) : look);
      table.push_back(lamp_current(shown, rig_.currents_of(rig_.buses[bus])));
    }
    return table;
  }

  const CueSchedule& schedule_;
  const Rig& rig_;
  const Drivers& drivers_;
  std::vector<std::size_t> supply_of_;
  std::vector<std::vector<std::size_t>> nodes_of_;
  std::map<std::pair<std::size_t, double>, std::vector<double>> tables_;
};

std::string cue_text(const Cue& cue, std::span<const CuePlay> plays) {
  if (!cue) return "in the opening";
  const auto& played = plays[*cue].cue;
  return fmt::format("in cue {}{}", played.number.to_text(), played.name.empty() ? "" : " \"" + played.name + "\"");
}

Diagnostic complaint(const Rig& rig, std::size_t supply, std::string text, std::string hint) {
  Diagnostic out;
  out.position = rig.supplies[supply].position;
  out.key_path = fmt::format("supplies[{}]", supply);
  out.text = fmt::format("the supply \"{}\" {}", rig.supplies[supply].name, text);
  out.hint = std::move(hint);
  return out;
}

/// One supply through the show: its loads, its dimmed cues, or why it cannot.
class Balance {
 public:
  Balance(std::size_t supply, const CueSchedule& schedule, const Rig& rig, std::span<const CuePlay> plays,
          Accounts& accounts)
      : supply_(rig.supplies[supply]), schedule_(schedule), rig_(rig), plays_(plays), accounts_(accounts) {
    load = accounts.standing(supply);
    room_a_ = supply_.limit_a - load.dark_a + kRounding_a;
  }

  SupplyLoad load;

  [[nodiscard]] std::optional<Diagnostic> settle() {
    if (load.unguided_a > supply_.limit_a + kRounding_a) {
      return complaint(rig_, load.supply,
                       fmt::format("has to give {:.2f} A as soon as it is switched on, and its limit is {:g} A: {} "
                                   "lamps that show NO-GUIDANCE by themselves, and {} nodes",
                                   load.unguided_a, supply_.limit_a, load.lamps, load.nodes),
                       "fewer nodes on it; nothing that a show does changes that");
    }
    for (const auto& [cue, most_a] : peaks_of_cues()) {
      if (most_a.first <= room_a_) continue;
      if (supply_.overload == Supply::Overload::refuse) {
        return overload(cue, most_a, "fewer or darker looks, `overload: dim`, or nodes on other supplies");
      }
      if (!dim(cue, most_a.first)) {
        return overload(cue, most_a,
                        "its lamps cannot be dimmed so far: they go down to a twentieth, on-off lamps not at all; "
                        "nodes on other supplies");
      }
    }
    sum_up();
    return std::nullopt;
  }

  [[nodiscard]] double factor_at(std::size_t k) const {
    const auto found = factors_.find(schedule_.switches()[k].cue);
    return found == factors_.end() ? 1 : found->second;
  }

 private:
  using Peak = std::pair<double, std::size_t>;  ///< ampere into lamps, switch

  [[nodiscard]] std::map<Cue, Peak> peaks_of_cues() {
    std::map<Cue, Peak> peaks;
    const auto& switches = schedule_.switches();
    for (std::size_t k = 0; k < switches.size(); ++k) {
      Peak& peak = peaks[switches[k].cue];
      const double lamps_a = accounts_.lamps_at(load.supply, k, 1).first;
      over_ += lamps_a > room_a_ ? 1 : 0;
      if (lamps_a > peak.first) peak = {lamps_a, k};
    }
    return peaks;
  }

  /// One factor for the cue with which all of its switches fit. @return false: there is none
  bool dim(const Cue& cue, double asked_a) {
    double factor = room_a_ / asked_a;
    const auto& switches = schedule_.switches();
    for (int round = 0; round < kRounds && factor > 0; ++round) {
      double most_a = 0;
      for (std::size_t k = 0; k < switches.size(); ++k) {
        if (switches[k].cue == cue) most_a = std::max(most_a, accounts_.lamps_at(load.supply, k, factor).first);
      }
      if (most_a <= room_a_) {
        factors_[cue] = factor;
        load.dimmed.push_back({cue, factor, asked_a + load.dark_a});
        return true;
      }
      factor *= 0.98 * room_a_ / most_a;
    }
    return false;
  }

  [[nodiscard]] Diagnostic overload(const Cue& cue, const Peak& peak, std::string hint) const {
    const Switch& at = schedule_.switches()[peak.second];
    return complaint(
        rig_, load.supply,
        fmt::format("is overloaded {} at {:.3f} s ({}): {:.2f} A, and its limit is {:g} A; so it is at {} of "
                    "{} switches",
                    cue_text(cue, plays_), to_seconds(at.time), at.cause, peak.first + load.dark_a, supply_.limit_a,
                    over_, schedule_.switches().size()),
        std::move(hint));
  }

  void sum_up() {
    const auto& switches = schedule_.switches();
    double weighted = 0;
    double time_s = 0;
    double last_a = 0;
    for (std::size_t k = 0; k < switches.size(); ++k) {
      const auto [peak_a, mean_a] = accounts_.lamps_at(load.supply, k, factor_at(k));
      if (peak_a + load.dark_a > load.peak_a) {
        load.peak_a = peak_a + load.dark_a;
        load.peak_at = k;
      }
      last_a = mean_a + load.dark_a;
      if (k + 1 == switches.size()) continue;
      const double lasts_s = to_seconds(switches[k + 1].time - switches[k].time);
      weighted += last_a * lasts_s;
      time_s += lasts_s;
    }
    load.mean_a = time_s > 0 ? weighted / time_s : last_a;
  }

  const Supply& supply_;
  const CueSchedule& schedule_;
  const Rig& rig_;
  std::span<const CuePlay> plays_;
  Accounts& accounts_;
  double room_a_ = 0;  ///< for lamps
  std::size_t over_ = 0;
  std::map<Cue, double> factors_;
};

/// The schedule with looks of their own for lamps that are dimmed.
Result<CueSchedule> with_dimmed(const CueSchedule& schedule, const Rig& rig, const Accounts& accounts,
                                const std::vector<Balance>& balances) {
  std::vector<Look> looks = schedule.looks();
  std::map<Look, std::size_t> numbers;
  for (std::size_t i = 1; i < looks.size(); ++i) numbers.emplace(looks[i], i);
  const std::size_t switches = schedule.switches().size();
  std::vector<LookIndex> table;
  table.reserve(switches * rig.nodes.size() * kChannelsPerNode);
  for (std::size_t k = 0; k < switches; ++k) {
    for (std::size_t n = 0; n < rig.nodes.size(); ++n) {
      const auto row = schedule.looks_of(k, NodeIndex::of(n));
      table.insert(table.end(), row.begin(), row.end());
    }
  }
  for (const Balance& balance : balances) {
    for (std::size_t k = 0; k < switches; ++k) {
      const double factor = balance.factor_at(k);
      if (factor >= 1) continue;
      for (const std::size_t n : accounts.nodes_of(balance.load.supply)) {
        for (std::size_t c = 0; c < rig.nodes[n].channels.size(); ++c) {
          LookIndex& index = table[(k * rig.nodes.size() + n) * kChannelsPerNode + c];
          if (index == kDark) continue;
          const Look look = dimmed(schedule.looks()[index], factor);
          const auto [number, is_new] = numbers.emplace(look, looks.size());
          if (is_new) looks.push_back(look);
          if (looks.size() <= kMostLooks) index = static_cast<LookIndex>(number->second);
        }
      }
    }
  }
  if (looks.size() > kMostLooks) {
    return refusal(fmt::format(
        "{}: error: supplies: dimmed looks and the show's own are {} together, and a marker's look table holds {} "
        "(darker looks from the start, or more supplies that carry them as they are)",
        rig.file, looks.size() - 1, kMostLooks));
  }
  CueSchedule out(std::move(looks), schedule.switches(), rig.nodes.size(), std::move(table), schedule.plan_byte(),
                  schedule.confusion());
  out.set_contents(schedule.contents());
  out.set_numbers(schedule.numbers());  // its looks are the first ones here
  return out;
}

}  // namespace

double lamp_current(const Look& look, const LampCurrents& currents) {
  const double colours =
      look.colour.red * currents.red_a + look.colour.green * currents.green_a + look.colour.blue * currents.blue_a;
  return colours / 255 * look.brightness / 255;
}

double mean_share(Effect effect) {
  switch (effect) {
    case Effect::steady:
      return 1;
    case Effect::blink:
    case Effect::pulse:
    case Effect::count_down:
      return 0.5;
    case Effect::double_blink:
      return 1.0 / 3;
  }
  return 1;
}

Result<CueSchedule> within_supplies(CueSchedule schedule, const Rig& rig, const Drivers& drivers,
                                    std::span<const CuePlay> plays) {
  FL_CHECK(drivers.size() == rig.buses.size());
  if (rig.supplies.empty()) return schedule;
  Accounts accounts(schedule, rig, drivers);
  std::vector<Balance> balances;
  std::string lines;
  std::size_t overloaded = 0;
  bool dims = false;
  for (std::size_t s = 0; s < rig.supplies.size(); ++s) {
    Balance& balance = balances.emplace_back(s, schedule, rig, plays, accounts);
    const auto wrong = balance.settle();
    dims = dims || !balance.load.dimmed.empty();
    if (!wrong || overloaded++ >= kShownSupplies) continue;
    lines += (lines.empty() ? "" : "\n") + to_text(*wrong);
  }
  if (overloaded > kShownSupplies) lines += fmt::format("\nand {} more supplies", overloaded - kShownSupplies);
  if (overloaded > 0) return refusal(lines);
  std::vector<SupplyLoad> loads;
  for (const Balance& balance : balances) loads.push_back(balance.load);
  if (dims) {
    auto changed = with_dimmed(schedule, rig, accounts, balances);
    if (changed) changed->set_supplies(std::move(loads));
    return changed;
  }
  schedule.set_supplies(std::move(loads));
  return schedule;
}

std::vector<SwitchOn> switch_on_of(const Rig& rig) {
  const std::vector<std::size_t> supplies = Accounts::supplies_of(rig);
  std::vector<Duration> next(rig.supplies.size());
  std::vector<SwitchOn> out(rig.nodes.size());
  for (std::size_t n = 0; n < out.size(); ++n) {
    if (supplies[n] == kNone) continue;
    const Duration stagger = rig.supplies[supplies[n]].stagger;
    out[n] = {supplies[n], next[supplies[n]], stagger};
    next[supplies[n]] += stagger;
  }
  return out;
}

}  // namespace footlight::controller
