// SPDX-License-Identifier: Apache-2.0
#include "app/readiness/early_desk.hpp"

#include <utility>

#include "app/readiness/readiness_view.hpp"

namespace footlight::app {

EarlyDesk::EarlyDesk(const Show& show, const Plan& plan, const Rig& rig, Readiness& readiness, const Clock& clock)
    : desk_(show, plan), readiness_(readiness), clock_(clock) {
  view_.show.position = desk_.orders().plays().front().from;
  view_.show.standby = 0;
  view_.show.barred = controller::kNotReady;
  for (std::size_t b = 0; b < rig.buses.size(); ++b) {
    std::size_t nodes = 0;
    for (const Node& node : rig.nodes) nodes += node.bus.at() == b ? 1 : 0;
    view_.buses.push_back({rig.buses[b].name, nodes, nodes});
  }
  desk_.add([this](DeskView& view) {
    view.readiness = view_of(readiness_);
    view.readiness.armed = false;
    view.readiness.question = question_;
    view.against.push_back(question_ ? "nobody has confirmed the probe lamp at " + question_->cell
                                     : std::string("the roll call is not over"));
  });
  desk_.add(RunDesk::Verb{"probe", "probe yes; no; skip          the lamp that is asked for shines, alone\n",
                          [this](const auto& words, const Speaker& who) { return answer(words, who); }});
}

void EarlyDesk::add(Surface& surface) {
  desk_.add(surface);
  listens_ = listens_ || surface.listens();
}

void EarlyDesk::look() {
  view_.show.at = view_.now = clock_.now();
  const DeskWishes wishes = desk_.look(view_);
  quits_ = quits_ || wishes.ends;
  for (const controller::Command& command : wishes.commands) {
    desk_.answered({command, controller::Outcome::not_ready, clock_.now()});
  }
}

void EarlyDesk::ask(std::string question, std::string cell) {
  question_ = {std::move(question), std::move(cell)};
  said_.reset();
}

Result<std::string> EarlyDesk::answer(const std::vector<std::string>& words, const Speaker& who) {
  if (!question_) return input_error("probe: nothing is asked");
  const ProbeAnswer answer = words.size() == 1 ? probe_answer(words[0]) : ProbeAnswer::unclear;
  if (answer == ProbeAnswer::unclear) return input_error("probe: yes, no or skip is wanted: " + question_->text);
  said_ = {answer, who.name};
  return question_->cell + (answer == ProbeAnswer::yes  ? " shines, and nothing else"
                            : answer == ProbeAnswer::no ? " does not shine where it should"
                                                        : " was not looked at");
}

}  // namespace footlight::app
