// SPDX-License-Identifier: Apache-2.0
#include "app/readiness/readiness_surface.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "app/readiness/readiness_view.hpp"

namespace footlight::app {
namespace {

using Stage = Readiness::Stage;
using State = Readiness::State;
using Phase = controller::Rehearsal::Phase;
using ResetState = controller::Rehearsal::ResetState;

/// Nodes that answer, by what they keep.
struct NodesBy {
  std::size_t same = 0;
  std::size_t none = 0;
  std::size_t unknown = 0;
  std::vector<std::string> other_plan{};
  std::vector<std::string> other_patch{};
  std::vector<std::string> no_patch{};

  void count(std::uint32_t flags, const std::string& node) {
    if ((flags & NodeBoard::kSameChecks) != 0) {
      ++same;
    } else if ((flags & NodeBoard::kNoChecks) != 0) {
      ++none;
    } else if ((flags & NodeBoard::kOtherPlan) != 0) {
      other_plan.push_back(node);
    } else if ((flags & NodeBoard::kOtherPatch) != 0) {
      other_patch.push_back(node);
    } else if ((flags & NodeBoard::kNoPatch) != 0) {
      no_patch.push_back(node);
    } else if ((flags & (NodeBoard::kSilent | NodeBoard::kQuarantined)) == 0) {
      ++unknown;
    }
  }
  /// What is wrong; empty: nothing.
  [[nodiscard]] std::string wrong() const {
    std::string text;
    const auto add = [&](const std::vector<std::string>& nodes, std::string_view what, std::string_view hint) {
      if (nodes.empty()) return;
      text += fmt::format("{}{}: {} ({})", text.empty() ? "" : "; ", what, names_text(nodes), hint);
    };
    add(other_patch, "the patch of another rig or node is on",
        "is it the node that the rig means? `footlight devices patch --write` when it is");
    add(no_patch, "no patch is on", "`footlight devices patch --write` when its lamps are where the rig says");
    add(other_plan, "another plan is on", "does another controller tell it?");
    return text;
  }
};

}  // namespace

ReadinessSurface::ReadinessSurface(Readiness& readiness, const Rig& rig, const NodeBoard& board,
                                   const BusHealth& health, RunDesk& desk, bool arms)
    : readiness_(readiness),
      rig_(rig),
      board_(board),
      health_(health),
      unfenced_(unfenced_text(rig.buses)),
      arms_(arms) {
  for (const Node& node : rig.nodes) markers_ += node.channels.size();
  desk.bar(controller::kNotReady, readiness.refuses_go());
  desk.add([this, &readiness](DeskView& view) {
    view.readiness = view_of(readiness);
    if (swap_) view.readiness.swap = {swap_->node(), swap_->step_name(), swap_->text()};
    if ((view.show.barred & controller::kNotReady) == 0) return;
    for (std::string& text : readiness.against()) view.against.push_back(std::move(text));
  });
  add_orders(desk);
}

void ReadinessSurface::add_orders(RunDesk& desk) {
  desk.add({"ready", "ready                        what is ready and what is not\n",
            [this](const std::vector<std::string>&, const Speaker&) -> Result<std::string> {
              return stages_text(readiness_);
            }});
  desk.add({"arm", "arm; disarm                  GO counts, where --scope live refuses it; refused again\n",
            [this](const std::vector<std::string>&, const Speaker&) { return readiness_.arm(); }});
  desk.add({"disarm", "", [this](const std::vector<std::string>&, const Speaker&) { return readiness_.disarm(); }});
  desk.add({"override", "override roll-call           you answer for a stage that is an ERROR\n",
            [this](const std::vector<std::string>& words, const Speaker& who) {
              return readiness_.override_stage(words.empty() ? "" : words[0], who.name);
            }});
  desk.add({"swap", "swap left-3; swap off        a node for a spare, while the show goes on\n",
            [this](const std::vector<std::string>& words, const Speaker&) { return start_swap(words); }});
}

void ReadinessSurface::look(const DeskView& view, RunDesk& desk) {
  judge_buses();
  judge_nodes(view);
  judge_time(view);
  follow_swap(desk);
  keep_places(view, desk);
  if (arms_ && !readiness_.armed() && readiness_.scope() == Scope::live) {
    if (const auto armed = readiness_.arm()) desk.tell({RunEvent::Kind::note, armed.value()});
  }
  desk.bar(controller::kNotReady, readiness_.refuses_go());
}

void ReadinessSurface::judge_buses() {
  std::string down;
  for (std::size_t b = 0; b < health_.buses(); ++b) {
    if (health_.down(b).empty()) continue;
    down += fmt::format("{}{} is down: {}", down.empty() ? "" : "; ", rig_.buses[b].name, health_.down(b));
  }
  if (!down.empty()) {
    readiness_.tell(Stage::buses, State::error, std::move(down));
  } else if (!unfenced_.empty()) {
    readiness_.tell(Stage::buses, State::warning, fmt::format("{} open; {}", health_.buses(), unfenced_));
  } else {
    readiness_.tell(Stage::buses, State::success, fmt::format("{} open", health_.buses()));
  }
}

void ReadinessSurface::judge_nodes(const DeskView& view) {
  if (!view.roll_called) {
    readiness_.tell(Stage::roll_call, State::waiting, "nodes are asked");
    return;
  }
  std::vector<std::string> silent;
  std::size_t silent_markers = 0;
  std::size_t unverified = 0;
  std::size_t unproved = 0;
  for (std::size_t n = 0; n < rig_.nodes.size(); ++n) {
    if (health_.silent(n)) {
      silent.push_back(rig_.nodes[n].name);
      silent_markers += rig_.nodes[n].channels.size();
    }
    if (health_.unproved(n)) {
      ++unproved;
    } else if ((board_.at(n).flags & NodeBoard::kUnverified) != 0) {
      ++unverified;
    }
  }
  const std::string answered = fmt::format("{} nodes answer", rig_.nodes.size() - silent.size());
  readiness_.tell(Stage::roll_call, silent.empty() ? State::success : State::error,
                  silent.empty() ? answered : silence_text(silent_markers, markers_, silent));
  judge_checks(unproved, unverified);
  readiness_.tell(Stage::looks, silent.empty() ? State::success : State::warning,
                  silent.empty() ? "uploaded" : "uploaded, not to who is silent");
}

/// Whether nodes show this plan, and keep it and this patch, as far as they can tell.
void ReadinessSurface::judge_checks(std::size_t unproved, std::size_t unverified) {
  NodesBy with;
  for (std::size_t n = 0; n < rig_.nodes.size(); ++n) with.count(board_.at(n).flags, rig_.nodes[n].name);
  std::string text = fmt::format("{} nodes confirm by sequence and check sum what this plan shows",
                                 rig_.nodes.size() - unproved - unverified);
  if (unproved > 0) text += fmt::format(", {} do not", unproved);
  if (unverified > 0) text += fmt::format(", {} cannot be read back", unverified);
  const bool untold = with.none > 0;
  if (with.same > 0) text += fmt::format("; {} keep this plan and patch", with.same);
  if (untold) text += fmt::format("; {} keep none", with.none);
  if (with.unknown > 0) text += fmt::format("; {} are asked for theirs", with.unknown);
  const std::string wrong = with.wrong();
  if (!wrong.empty()) {
    readiness_.tell(Stage::plan_on_nodes, State::error, wrong);
  } else if (with.unknown > 0 && !readiness_.armed()) {
    readiness_.tell(Stage::plan_on_nodes, State::waiting, std::move(text));
  } else {
    readiness_.tell(Stage::plan_on_nodes, unproved + unverified > 0 || untold ? State::warning : State::success,
                    std::move(text));
  }
}

/// A source that leads has to have been locked before the show; music goes with the show.
void ReadinessSurface::judge_time(const DeskView& view) {
  if (view.time_source == "internal" || readiness_.armed()) return;
  const controller::TimeFollower::State lock = view.show.time.state;
  const bool music = view.time_source.starts_with("audio ");
  const bool locked = lock == controller::TimeFollower::State::locked;
  // A rehearsal may go on without it.
  const State missing = readiness_.scope() == Scope::live ? State::waiting : State::warning;
  readiness_.tell(
      Stage::time, music || locked ? State::success : missing,
      view.time_source + (music                                           ? ": goes with the show"
                          : lock == controller::TimeFollower::State::none ? ": nothing yet"
                                                                          : ": " + std::string(to_text(lock))));
}

Result<std::string> ReadinessSurface::start_swap(const std::vector<std::string>& words) {
  const std::string name = words.empty() ? "" : words[0];
  if (name == "off") {
    if (!swap_) return input_error("swap: none is under way");
    if (!swap_->over()) swap_->give_up();
    std::string text = swap_->text();
    swap_.reset();
    return text;
  }
  const auto node = std::ranges::find(rig_.nodes, name, &Node::name);
  if (node == rig_.nodes.end()) return input_error("swap: the rig has no node \"" + name + "\"");
  swapped_ = static_cast<std::size_t>(node - rig_.nodes.begin());
  swap_.emplace(node->name, node->address, rig_.buses[node->bus.at()].name);
  return swap_->text();
}

void ReadinessSurface::follow_swap(RunDesk& desk) {
  if (!swap_ || swap_->over()) return;
  const NodeBoard::View node = board_.at(swapped_);
  const bool silent = (node.flags & (NodeBoard::kSilent | NodeBoard::kQuarantined)) != 0;
  if (swap_->look(silent, (node.flags & NodeBoard::kRight) != 0)) desk.tell({RunEvent::Kind::note, swap_->text()});
}

/// Where nobody is on the stage nobody has to be led from one place to another.
void ReadinessSurface::keep_places(const DeskView& view, RunDesk& desk) {
  if (readiness_.scope() != Scope::lights_only) return;
  const auto& reset = view.show.reset;
  const bool stands = view.show.phase == Phase::stands || view.show.phase == Phase::finished;
  if (!stands || reset.state == ResetState::none || reset.id == placed_for_) return;
  placed_for_ = reset.id;
  desk.say("placed", {controller::GoSource::lines, "scope lights-only"});
}

}  // namespace footlight::app
