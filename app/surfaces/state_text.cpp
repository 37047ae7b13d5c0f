// SPDX-License-Identifier: Apache-2.0
#include "app/surfaces/state_text.hpp"

#include <array>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/surfaces/show_timecode.hpp"

namespace footlight::app {
namespace {

using Json = nlohmann::ordered_json;
using Phase = controller::Rehearsal::Phase;
using ResetState = controller::Rehearsal::ResetState;

double seconds_left(Instant until, Instant now) { return std::max(0.0, to_seconds(until - now)); }

std::string_view to_text(ResetState state) {
  switch (state) {
    case ResetState::none:
      return "none";
    case ResetState::wanted:
      return "being-planned";
    case ResetState::ready:
      return "ready";
    case ResetState::impossible:
      return "impossible";
  }
  return "";
}

std::size_t untold_of(const EditView& edit) { return edit.untold ? edit.untold->size() : 0; }

Json question_of(const ReadinessView& readiness) {
  if (!readiness.question) return nullptr;
  return {{"text", readiness.question->text}, {"cell", readiness.question->cell}};
}

Json swap_of(const ReadinessView& readiness) {
  if (!readiness.swap) return nullptr;
  return {{"node", readiness.swap->node}, {"step", readiness.swap->step}, {"text", readiness.swap->text}};
}

std::string_view to_text(GateView::State state) {
  switch (state) {
    case GateView::State::closed:
      return "closed";
    case GateView::State::open:
      return "open";
    case GateView::State::lost:
      return "lost";
    case GateView::State::by_word:
      return "by-word";
  }
  return "";
}

}  // namespace

std::string_view StateText::to_text(Phase phase) {
  switch (phase) {
    case Phase::stands:
      return "stands";
    case Phase::counts_in:
      return "counts-in";
    case Phase::runs:
      return "runs";
    case Phase::resets:
      return "resets";
    case Phase::reset_held:
      return "reset-held";
    case Phase::finished:
      return "finished";
  }
  return "";
}

std::string_view StateText::section_at(Instant position) const {
  // The walk into a section belongs to it.
  for (const PlanSection& section : plan_.sections) {
    if (position <= section.end) return section.name;
  }
  return plan_.sections.empty() ? std::string_view() : std::string_view(plan_.sections.back().name);
}

std::string StateText::cue(int cue) const {
  const Cue& it = plays_[static_cast<std::size_t>(cue)].cue;
  return it.number.to_text() + (it.name.empty() ? "" : " " + it.name);
}

std::string StateText::what_happens(const ShowState& state) const {
  const auto in = [&](Instant at) { return fmt::format("in {:.1f} s", seconds_left(at, state.at)); };
  const bool runs = state.phase == Phase::runs || state.phase == Phase::counts_in;
  if (state.phase == Phase::resets) return state.goes_at != kNever ? "reset move " + in(state.goes_at) : "reset move";
  if (state.phase == Phase::reset_held) return "HOLD in the reset move: GO goes on";
  if (!runs && state.reset.state == ResetState::wanted) return "the reset move is being planned";
  if (!runs && state.reset.state == ResetState::impossible) {
    return "NO RESET MOVE: send people by word of mouth, then \"placed\"";
  }
  if (!runs && state.reset.state == ResetState::ready) {
    return state.position == state.reset.from ? "GO lights the reset move: are people where they should be?"
                                              : "GO: people walk on to the end of the set, then the reset move";
  }
  if (state.phase == Phase::finished) return "the show is over";
  const std::string next = state.standby < 0 ? "the end" : cue(state.standby);
  if (state.phase == Phase::stands) {
    if (state.active >= 0) return fmt::format("HOLD in cue {}: GO goes on", cue(state.active));
    return "GO for cue " + next;
  }
  std::string text = "cue " + cue(state.active);
  if (state.phase == Phase::counts_in) return text + " goes " + in(state.goes_at);
  const auto& gap = plays_[static_cast<std::size_t>(state.active)].gap_after;
  text += state.standby < 0 ? " runs, the end "
          : gap             ? " runs, then by itself " + next + " "
                            : " runs, GO for " + next + " ";
  text += in(state.ends_at);
  if (state.holds_at_end) text += ", HOLD at the end of the set";
  return text;
}

std::string StateText::buses(const std::vector<BusView>& buses) const {
  std::size_t nodes = 0;
  std::string wrong;
  for (const BusView& bus : buses) {
    nodes += bus.nodes;
    if (bus.unconfirmed == 0 && bus.trouble.empty()) continue;
    if (!bus.trouble.empty()) {
      wrong += fmt::format("{}{} DOWN", wrong.empty() ? "" : ", ", bus.name);
      continue;
    }
    wrong += fmt::format("{}{} {}/{} NOT RIGHT", wrong.empty() ? "" : ", ", bus.name, bus.unconfirmed, bus.nodes);
  }
  return wrong.empty() ? fmt::format("all {} nodes right", nodes) : wrong;
}

/// What a HOLD would do now, while one is possible; what GO would, after it.
std::string StateText::freeze(const DeskView& view) const {
  const ShowState& state = view.show;
  const FreezeView& freeze = view.freeze;
  if (!freeze.known) return "";
  const auto pairs = [](std::uint32_t count) {
    return fmt::format("{} pair{} may touch", count, count == 1 ? "" : "s");
  };
  const bool held = (state.phase == Phase::stands && state.active >= 0) || state.phase == Phase::reset_held;
  if (held && freeze.resume_pairs > 0) {
    return " | going on: " + pairs(freeze.resume_pairs) + " where people have walked on";
  }
  if (state.phase != Phase::runs && state.phase != Phase::resets) return "";
  if (freeze.pairs == 0) return " | freeze safe";
  if (state.phase == Phase::resets) return " | freeze: " + pairs(freeze.pairs);  // a reset move has no set to end
  if (freeze.none_from == kNever) return " | freeze: " + pairs(freeze.pairs) + "; HOLD at the end is better";
  return fmt::format(" | freeze: {} until count {:.0f}; HOLD at the end is better", pairs(freeze.pairs),
                     std::ceil(show_.tempo.count_at(freeze.none_from)));
}

std::string StateText::edit(const EditView& edit) {
  using State = EditView::State;
  std::string text;
  if (edit.state == State::planning) text = " | a change is being planned";
  if (edit.state == State::wrong) text = " | WHAT HAS CHANGED IS WRONG";
  if (edit.state == State::waits || edit.state == State::taking) {
    text = fmt::format(" | changed: {} transitions, {} people, {}", edit.transitions, edit.people,
                       edit.state == State::waits ? "take or discard" : "taken where the show stands next");
  }
  if (!edit.absent.empty()) text += fmt::format(" | {} absent", edit.absent.size());
  if (untold_of(edit) > 0) text += fmt::format(" | {} to be told", untold_of(edit));
  return text;
}

std::string StateText::line(const DeskView& view) const {
  const ShowState& state = view.show;
  const double count = show_.tempo.count_at(state.position);
  std::string tempo = fmt::format("{} %", state.percent);
  if (state.percent == state.limit_percent) tempo += " (at most)";
  if (!view.muted.empty()) tempo += ", not guided: " + view.muted;
  if (state.loops) {
    tempo +=
        fmt::format(", loop {:.4g}-{:.4g}", show_.tempo.count_at(state.loop.from), show_.tempo.count_at(state.loop.to));
  }
  const std::string notes = view.standby_notes.empty() ? "" : " (" + view.standby_notes + ")";
  std::string against;
  for (const std::string& one : view.against) against += (against.empty() ? " | NO GO: " : ", ") + one;
  return fmt::format("{} {} count {:.0f} | {}{} | {}{}{} | {}{}", section_at(state.position),
                     show_.tempo.measure_beat(std::floor(count)), std::floor(count), tempo, time_line(view),
                     what_happens(state), notes + freeze(view), against, buses(view.buses), edit(view.edit));
}

Json StateText::time_of(const DeskView& view) const {
  const controller::Chase::View& time = view.show.time;
  Json out{{"source", view.time_source}, {"lock", controller::to_text(time.state)}};
  if (time.state == controller::TimeFollower::State::none) return out;
  out["on"] = time.on;
  out["armed"] = time.armed;
  out["follows"] = time.follows;
  out["position_s"] = to_seconds(time.source);
  out["timecode"] = timecode_at(time.source);
  out["off_s"] = to_seconds(time.off);
  out["rate_percent"] = 100 * time.rate;
  return out;
}

std::string StateText::timecode_at(Instant position) const {
  return timecode_text(position.time_since_epoch() + show_.time.start, show_.time.rate);
}

/// "ltc tape.wav 01:00:12:04 locked, follows"; empty: the machine's own clock.
std::string StateText::time_line(const DeskView& view) const {
  using State = controller::TimeFollower::State;
  const controller::Chase::View& time = view.show.time;
  if (view.time_source == "internal") return {};
  if (time.state == State::none) return fmt::format(" | {}: nothing yet", view.time_source);
  const std::string what = !time.on       ? "off"
                           : time.follows ? fmt::format("follows, {:+.0f} ms", to_seconds(time.off) * 1e3)
                           : !time.armed  ? "waits for GO"
                                          : fmt::format("{:+.1f} s from the show", to_seconds(time.off));
  return fmt::format(" | {} {} {}, {}", view.time_source, timecode_at(time.source), controller::to_text(time.state),
                     what);
}

std::string StateText::changes(const DeskView& view) {
  const ShowState& state = view.show;
  std::string now = fmt::format("{} {} {} {} {} {} {} {} {} {}", static_cast<int>(state.phase), state.reset.id,
                                static_cast<int>(state.reset.state), state.active, state.standby, state.percent,
                                state.target.current, state.holds_at_end, state.loops, view.roll_called);
  now += fmt::format(" {} {} {} {}", static_cast<int>(state.time.state), state.time.on, state.time.armed,
                     state.time.follows);
  for (const std::string& against : view.against) now += " " + against;
  for (const GateView& gate : view.gates) now += fmt::format(" {}", static_cast<int>(gate.state));
  for (const ReadinessView::Stage& stage : view.readiness.stages) now += fmt::format(" {}", stage.state);
  now += view.readiness.armed ? " armed" : " refused";
  if (view.readiness.question) now += " " + view.readiness.question->cell;
  if (view.readiness.swap) now += " " + view.readiness.swap->text;
  for (const BusView& bus : view.buses) now += fmt::format(" {} {} {}", bus.unconfirmed, bus.silent, bus.trouble);
  now += fmt::format(" {} {}", view.freeze.known, view.muted);
  now += fmt::format(" {} {} {}", static_cast<int>(view.edit.state), view.edit.people, untold_of(view.edit));
  for (const EditView::Absent& one : view.edit.absent) now += " " + one.id + "=" + one.cover;
  return now;
}

std::string StateText::json(const DeskView& view) const {
  const ShowState& state = view.show;
  const double count = show_.tempo.count_at(state.position);
  const auto number = [&](int cue) {
    return cue < 0 ? Json(nullptr) : Json(plays_[static_cast<std::size_t>(cue)].cue.number.to_text());
  };
  const auto left = [&](Instant at) { return at == kNever ? Json(nullptr) : Json(seconds_left(at, state.at)); };
  const bool resets = state.phase == Phase::resets || state.phase == Phase::reset_held;
  const bool moves = state.phase == Phase::runs || (state.phase == Phase::resets && state.goes_at == kNever);
  Json reset{{"state", app::to_text(state.reset.state)}};
  if (state.reset.state != ResetState::none) {
    reset["from_s"] = to_seconds(state.reset.from);
    reset["to_s"] = to_seconds(state.reset.to);
  }
  if (resets) reset["at_s"] = to_seconds(state.target.show_time);
  Json buses = Json::array();
  for (const BusView& bus : view.buses) {
    buses.push_back({{"name", bus.name},
                     {"nodes", bus.nodes},
                     {"unconfirmed", bus.unconfirmed},
                     {"silent", bus.silent},
                     {"trouble", bus.trouble}});
  }
  Json gates = Json::array();
  for (const GateView& gate : view.gates) gates.push_back({{"name", gate.name}, {"state", app::to_text(gate.state)}});
  Json readiness = nullptr;
  if (!view.readiness.scope.empty()) {
    readiness = {{"scope", view.readiness.scope}, {"armed", view.readiness.armed}, {"stages", Json::array()}};
    for (const ReadinessView::Stage& stage : view.readiness.stages) {
      readiness["stages"].push_back({{"name", stage.name}, {"state", stage.state}, {"text", stage.text}});
    }
  }
  Json absent = Json::array();
  for (const EditView::Absent& one : view.edit.absent) {
    absent.push_back({{"id", one.id}, {"cover", one.cover.empty() ? Json(nullptr) : Json(one.cover)}});
  }
  constexpr std::array<std::string_view, 5> kEdits{"none", "planning", "wrong", "waits", "taking"};
  const Json changes{{"state", kEdits.at(static_cast<std::size_t>(view.edit.state))},
                     {"text", view.edit.text},
                     {"transitions", view.edit.transitions},
                     {"people", view.edit.people},
                     {"untold", untold_of(view.edit)},
                     {"absent", std::move(absent)}};
  Json freeze = nullptr;
  if (view.freeze.known) {
    const Instant none_from = view.freeze.none_from;
    freeze = {{"pairs", view.freeze.pairs},
              {"until_count", none_from == kNever ? Json(nullptr) : Json(show_.tempo.count_at(none_from))},
              {"resume_pairs", view.freeze.resume_pairs}};
  }
  const int of_cue = state.active >= 0 ? state.active : state.standby;
  const bool limited = view.limits != nullptr && of_cue >= 0 && static_cast<std::size_t>(of_cue) < view.limits->size();
  Json loop = nullptr;
  if (state.loops) loop = {{"from_s", to_seconds(state.loop.from)}, {"to_s", to_seconds(state.loop.to)}};
  const Json document{
      {"phase", to_text(state.phase)},
      {"position_s", to_seconds(state.position)},
      {"rate", moves ? state.target.rate : 0.0},
      {"section", section_at(state.position)},
      {"measure", show_.tempo.measure_beat(std::floor(count))},
      {"count", count},
      {"cue", number(state.active)},
      {"standby", number(state.standby)},
      {"standby_notes", view.standby_notes},
      {"goes_in_s", left(state.goes_at)},
      {"ends_in_s", left(state.ends_at)},
      {"tempo_percent", state.percent},
      {"most_percent", state.limit_percent},
      {"most_because", limited ? (*view.limits)[static_cast<std::size_t>(of_cue)].because : ""},
      {"freeze", std::move(freeze)},
      {"muted", view.muted},
      {"holds_at_end", state.holds_at_end},
      {"loop", std::move(loop)},
      {"reset", std::move(reset)},
      {"time", time_of(view)},
      {"switch", view.schedule != nullptr ? view.schedule->plain(state.target.current) : state.target.current},
      {"edit", changes},
      {"gates", std::move(gates)},
      {"against", view.against},
      {"readiness", std::move(readiness)},
      {"question", question_of(view.readiness)},
      {"swap", swap_of(view.readiness)},
      {"ready", view.roll_called},
      {"buses", std::move(buses)}};
  return Json{{"state", document}}.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace footlight::app
