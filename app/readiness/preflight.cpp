// SPDX-License-Identifier: Apache-2.0
#include "app/readiness/preflight.hpp"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/commission/flash_sequence.hpp"
#include "app/commission/floor_lights.hpp"
#include "app/device_bus.hpp"
#include "app/readiness/probes.hpp"
#include "app/typed_lines.hpp"

namespace footlight::app {
namespace {

using Stage = Readiness::Stage;
using State = Readiness::State;
using controller::FoundNode;

constexpr Duration kSettles = milliseconds(5000);
constexpr Duration kLook = milliseconds(50);

std::string ids_of(const FoundNode& node) {
  std::string ids;
  for (const drivers::Identity& identity : node.identities) {
    if (!identity.unique_id) continue;
    ids += fmt::format("{}{:08X}", ids.empty() ? "unique ids " : ", ", *identity.unique_id);
  }
  return ids.empty() ? "" : " (" + ids + ")";
}

/// What a roll call has found, a sentence for each.
struct Doubles {
  std::vector<std::string> proved;     ///< two unique ids at one address
  std::vector<std::string> suspected;  ///< answers over each other, of devices without unique ids
};

/// Asks one bus who is there.
Status<> call_roll_of(Session& session, const DeviceBusChoice& choice, Doubles& doubles, bool& can_be_asked) {
  auto bus = DeviceBus::open(session, choice);
  if (!bus) return std::move(bus).error();
  DeviceBus& it = **bus;
  can_be_asked = it.driver().refusal(drivers::Task::probe).empty();
  if (!can_be_asked || it.nodes().empty()) return Done{};
  const auto [first, last] = std::ranges::minmax(it.nodes(), {}, &drivers::NodeAddress::address);
  controller::BusService service(it.driver(), it.nodes());
  service.scan(first.address, last.address);
  if (auto asked = it.run(session, service, "roll call on " + choice.bus); !asked) return asked;
  for (const FoundNode& node : service.found()) {
    if (node.kind != FoundNode::Kind::twofold) continue;
    const auto with_id = [](const drivers::Identity& identity) { return identity.unique_id.has_value(); };
    const bool proved = std::ranges::count_if(node.identities, with_id) > 1;
    (proved ? doubles.proved : doubles.suspected)
        .push_back(
            fmt::format("{}: several devices at address {}{}", it.name_of(node.address), node.address, ids_of(node)));
  }
  return Done{};
}

/// In a rehearsal a bus that cannot be asked is a note, and so are answers over each other, which a bad line has, too.
Status<> call_roll(Session& session, const BusesToAsk& buses, Readiness& readiness) {
  const bool live = readiness.scope() == Scope::live;
  Doubles doubles;
  for (const Bus& bus : buses.wires.buses) {
    DeviceBusChoice choice;
    choice.bus = bus.name;
    choice.show = buses.show;
    choice.transports = buses.transports;
    bool can_be_asked = false;
    const auto called = call_roll_of(session, choice, doubles, can_be_asked);
    if (!called && (live || called.error().kind == ErrorKind::interrupted)) return called;
    if (!called) {
      session.note("roll call: " + called.error().message);
    } else if (!can_be_asked && live) {
      session.note("bus " + bus.name + ": its devices cannot say who they are");
    }
  }
  std::vector<std::string> wrong = doubles.proved;
  if (live) wrong.insert(wrong.end(), doubles.suspected.begin(), doubles.suspected.end());
  if (!live) {
    for (const std::string& one : doubles.suspected) session.note(one + ", or a line that garbles answers");
  }
  if (wrong.empty()) return Done{};
  std::string text = "two devices at one address, `footlight devices set-address` tells them apart: ";
  for (std::size_t i = 0; i < wrong.size(); ++i) text += (i > 0 ? "; " : "") + wrong[i];
  session.note(text);
  readiness.tell(Stage::roll_call, State::error, std::move(text), true);
  return Done{};
}

/// Asks until the answer is clear. @return nothing when nobody is left to ask
std::optional<ProbeAnswer> ask(Session& session, TypedLines& typed, FloorLights& lights, const std::string& question) {
  while (true) {
    session.note(question);
    const auto line = typed.next([&] { return lights.run_until(lights.now() + kLook); });
    if (!line) return std::nullopt;
    const ProbeAnswer answer = probe_answer(*line);
    if (answer != ProbeAnswer::unclear) return answer;
    session.note("yes, no or skip");
  }
}

Status<> light_probes(Session& session, const Show& show, const Rig& wires, Readiness& readiness) {
  const std::vector<FloorLamp> lamps = lamps_of(wires);
  const std::vector<std::size_t> chosen = probe_lamps(lamps, show.stage.grid);
  if (chosen.empty()) {
    readiness.tell(Stage::probes, State::skipped, "the floor has no lamp with a cell");
    return Done{};
  }
  auto lights = FloorLights::open(wires, {}, session.stop());
  if (!lights) return std::move(lights).error();
  std::vector<LitLamps> switches(1);  // dark
  for (const std::size_t lamp : chosen) switches.push_back({{}, {lamp}});
  (*lights)->load(lit_schedule(wires, lamps, lamp_white(wires), switches));
  const Error interrupted{ErrorKind::interrupted, "interrupted"};
  if (!(*lights)->settle(kSettles)) return interrupted;
  TypedLines typed;
  bool skipped = false;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const FloorLamp& lamp = lamps[chosen[i]];
    const std::string cell = show.stage.grid.name(*lamp.cell);
    (*lights)->light(i + 1, (*lights)->now() + (*lights)->notice());
    if (!(*lights)->run_until((*lights)->now() + (*lights)->notice()) || !(*lights)->settle(kSettles)) {
      return interrupted;
    }
    const auto answer = ask(session, typed, **lights,
                            fmt::format("probe {} of {}: {} ({}) shines, and nothing else. Does it? yes, no, skip",
                                        i + 1, chosen.size(), cell, lamp_name(wires, lamp.place)));
    if (!answer && session.stopped()) return interrupted;
    if (!answer || *answer == ProbeAnswer::no) {
      readiness.tell(Stage::probes, State::error,
                     answer ? cell + " does not shine where the plan thinks: is this its floor, the right way round?"
                            : "nobody has confirmed " + cell);
      return Done{};
    }
    skipped = skipped || *answer == ProbeAnswer::skip;
  }
  readiness.tell(Stage::probes, skipped ? State::warning : State::success,
                 skipped ? "not all of three lamps were looked at" : "three lamps shine where they should");
  return Done{};
}

}  // namespace

void ReadyOptions::add_options(CLI::App& command) {
  static const std::map<std::string, Scope> kScopes{{"none", Scope::none},
                                                    {"rehearsal", Scope::rehearsal},
                                                    {"live", Scope::live},
                                                    {"lights-only", Scope::lights_only}};
  command
      .add_option("--scope", scope,
                  "none: the checks alone, no port is opened; rehearsal; live: roll call and probe lamps first, GO is "
                  "refused until somebody says arm; lights-only: nobody is on the stage, nobody is led back")
      ->transform(CLI::CheckedTransformer(kScopes))
      ->default_str("rehearsal");
}

Status<> preflight(Session& session, const BusesToAsk& buses, const Show& show, Readiness& readiness) {
  readiness.tell(Stage::show, State::success, "valid");
  readiness.tell(Stage::plan, State::success, "proved, and of this very show");
  if (readiness.scope() == Scope::none) return Done{};
  readiness.tell(Stage::time, State::skipped, "the show's own clock");
  if (readiness.scope() != Scope::live) readiness.tell(Stage::probes, State::skipped, "only --scope live asks");
  if (buses.outlived) {
    readiness.take_up(*buses.outlived);
    return Done{};
  }
  if (auto called = call_roll(session, buses, readiness); !called) return called;
  if (readiness.scope() != Scope::live) return Done{};
  return light_probes(session, show, buses.wires, readiness);
}

}  // namespace footlight::app
