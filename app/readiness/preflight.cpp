// SPDX-License-Identifier: Apache-2.0
#include "app/readiness/preflight.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <future>
#include <iterator>
#include <map>
#include <thread>
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

/// What a bus has answered.
struct Called {
  Status<> asked = Done{};
  bool can_be_asked = false;
  // A sentence for each.
  std::vector<std::string> proved{};     ///< two unique ids at one address
  std::vector<std::string> suspected{};  ///< answers over each other, of devices without unique ids
};

/// Asks one bus who is there. A thread of its own.
Called call_roll_of(Session session, const Rig& wires, const std::string& name) {
  Called called;
  session.quiet = true;  // the calling thread tells
  DeviceBusChoice choice;
  choice.bus = name;
  choice.rig = &wires;
  auto bus = DeviceBus::open(session, choice);
  if (!bus) {
    called.asked = std::move(bus).error();
    return called;
  }
  DeviceBus& it = **bus;
  called.can_be_asked = it.driver().refusal(drivers::Task::probe).empty();
  if (!called.can_be_asked || it.nodes().empty()) return called;
  const auto [first, last] = std::ranges::minmax(it.nodes(), {}, &drivers::NodeAddress::address);
  controller::BusService service(it.driver(), it.nodes());
  service.scan(first.address, last.address);
  called.asked = it.run(session, service, "roll call on " + name);
  if (!called.asked) return called;
  for (const FoundNode& node : service.found()) {
    if (node.kind != FoundNode::Kind::twofold) continue;
    const auto with_id = [](const drivers::Identity& identity) { return identity.unique_id.has_value(); };
    const bool proved = std::ranges::count_if(node.identities, with_id) > 1;
    (proved ? called.proved : called.suspected)
        .push_back(
            fmt::format("{}: several devices at address {}{}", it.name_of(node.address), node.address, ids_of(node)));
  }
  return called;
}

/// All buses at once, for a floor of many is asked as fast as its slowest bus. In a rehearsal a bus that cannot be
/// asked is a note, and so are answers over each other, which a bad line has, too.
Status<> call_roll(Session& session, const BusesToAsk& buses, Readiness& readiness, EarlyDesk& desk) {
  const bool live = readiness.scope() == Scope::live;
  std::vector<std::future<Called>> under_way;
  for (const Bus& bus : buses.wires.buses) {
    under_way.push_back(std::async(std::launch::async, call_roll_of, session, std::cref(buses.wires), bus.name));
  }
  const auto is_over = [](const auto& one) {
    return one.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  };
  for (std::size_t over = 0; over < under_way.size();) {
    over = static_cast<std::size_t>(std::ranges::count_if(under_way, is_over));
    readiness.tell(Stage::roll_call, State::waiting,
                   fmt::format("who is there? {} of {} buses have answered", over, under_way.size()));
    session.tell("roll call", static_cast<double>(over) / static_cast<double>(under_way.size()));
    desk.look();
    if (over < under_way.size()) std::this_thread::sleep_for(kLook);
  }
  session.clear_line();
  std::vector<std::string> wrong;
  for (std::size_t b = 0; b < under_way.size(); ++b) {
    Called called = under_way[b].get();
    if (!called.asked && (live || called.asked.error().kind == ErrorKind::interrupted)) return called.asked;
    if (!called.asked) {
      session.note("roll call: " + called.asked.error().message);
    } else if (!called.can_be_asked && live) {
      session.note("bus " + buses.wires.buses[b].name + ": its devices cannot say who they are");
    }
    std::ranges::move(called.proved, std::back_inserter(wrong));
    for (std::string& one : called.suspected) {
      if (live) {
        wrong.push_back(std::move(one));
      } else {
        session.note(one + ", or a line that garbles answers");
      }
    }
  }
  if (desk.quits()) return Error{ErrorKind::interrupted, "interrupted"};
  readiness.tell(Stage::roll_call, State::waiting, "the show's own follows");
  if (wrong.empty()) return Done{};
  std::string text = "two devices at one address, `footlight devices set-address` tells them apart: ";
  for (std::size_t i = 0; i < wrong.size(); ++i) text += (i > 0 ? "; " : "") + wrong[i];
  session.note(text);
  readiness.tell(Stage::roll_call, State::error, std::move(text), true);
  return Done{};
}

/// Asks until the answer is clear, on stdin and at the desk. @return nothing when nobody is left to ask
std::optional<EarlyDesk::Said> ask(Session& session, TypedLines& typed, FloorLights& lights, EarlyDesk& desk,
                                   const std::string& question, const std::string& cell) {
  session.note(question + " yes, no, skip");
  desk.ask(question, cell);
  const auto waits = [&] {
    desk.look();
    return !desk.said() && !desk.quits() && lights.run_until(lights.now() + kLook);
  };
  while (true) {
    const auto line = typed.next(waits);
    if (desk.said()) return desk.said();
    if (!line) {
      // Of a closed stdin nothing comes any more; a page may still answer.
      if (desk.listens() && waits()) continue;
      if (desk.said()) return desk.said();
      return std::nullopt;
    }
    const ProbeAnswer answer = probe_answer(*line);
    if (answer != ProbeAnswer::unclear) return EarlyDesk::Said{answer, ""};
    session.note("yes, no or skip");
  }
}

/// Until all nodes that answer show it. @return false when told to stop
bool settle(FloorLights& lights, EarlyDesk& desk) {
  const Instant until = lights.now() + kSettles;
  while (lights.unconfirmed() > 0 && lights.now() < until) {
    desk.look();
    if (desk.quits() || !lights.settle(kLook)) return false;
  }
  return lights.settle(kLook);
}

Status<> light_probes(Session& session, const Show& show, const Rig& wires, Readiness& readiness, EarlyDesk& desk) {
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
  readiness.tell(Stage::probes, State::waiting, "the floor is made dark for them");
  if (!settle(**lights, desk)) return interrupted;
  TypedLines typed;
  bool skipped = false;
  std::string who;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const FloorLamp& lamp = lamps[chosen[i]];
    const std::string cell = show.stage.grid.name(*lamp.cell);
    (*lights)->light(i + 1, (*lights)->now() + (*lights)->notice());
    readiness.tell(Stage::probes, State::waiting, fmt::format("{} of {}: {}", i + 1, chosen.size(), cell));
    if (!(*lights)->run_until((*lights)->now() + (*lights)->notice()) || !settle(**lights, desk)) return interrupted;
    const auto said = ask(session, typed, **lights, desk,
                          fmt::format("probe {} of {}: {} ({}) shines, and nothing else. Does it?", i + 1,
                                      chosen.size(), cell, lamp_name(wires, lamp.place)),
                          cell);
    desk.asked();
    if (!said && (session.stopped() || desk.quits())) return interrupted;
    if (!said || said->answer == ProbeAnswer::no) {
      readiness.tell(Stage::probes, State::error,
                     said ? cell + " does not shine where the plan thinks: is this its floor, the right way round?"
                          : "nobody has confirmed " + cell);
      return Done{};
    }
    skipped = skipped || said->answer == ProbeAnswer::skip;
    if (!said->who.empty()) who = ", says " + said->who;
  }
  readiness.tell(Stage::probes, skipped ? State::warning : State::success,
                 (skipped ? "not all of three lamps were looked at" : "three lamps shine where they should") + who);
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

Status<> preflight(Session& session, const BusesToAsk& buses, const Show& show, Readiness& readiness, EarlyDesk& desk) {
  readiness.tell(Stage::show, State::success, "valid");
  readiness.tell(Stage::plan, State::success, "proved, and of this very show");
  if (readiness.scope() == Scope::none) return Done{};
  readiness.tell(Stage::time, State::skipped, "the show's own clock");
  if (readiness.scope() != Scope::live) readiness.tell(Stage::probes, State::skipped, "only --scope live asks");
  if (buses.outlived) {
    readiness.take_up(*buses.outlived);
    return Done{};
  }
  if (auto called = call_roll(session, buses, readiness, desk); !called) return called;
  if (readiness.scope() != Scope::live) return Done{};
  return light_probes(session, show, buses.wires, readiness, desk);
}

}  // namespace footlight::app
