// SPDX-License-Identifier: Apache-2.0
#include "app/edit/show_editing.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "app/edit/same_place.hpp"
#include "app/live/reset_moves.hpp"
#include "app/natural_order.hpp"
#include "app/reset_way.hpp"
#include "controller/stands.hpp"

namespace footlight::app {
namespace {

using Phase = controller::Rehearsal::Phase;

bool is_ready(const auto& future) {
  return future.valid() && future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

/// Where people stand in one plan at one instant, in the order of another one; who is new stands where she has to be.
std::vector<CellIndex> cells_from(const Plan& before, Instant from, const Plan& now,
                                  const std::vector<CellIndex>& goals) {
  std::map<std::string, std::size_t> known;
  for (std::size_t p = 0; p < before.performers.size(); ++p) known.emplace(before.performers[p], p);
  const std::vector<CellIndex> cells = controller::cells_at(before, from);
  std::vector<CellIndex> out = goals;
  for (std::size_t p = 0; p < now.performers.size(); ++p) {
    const auto was = known.find(now.performers[p]);
    if (was == known.end()) continue;
    // Grids may differ: the cell whose middle is nearest to where she stands.
    const Point at = before.stage.grid.centre(cells[was->second]);
    out[p] = now.stage.grid.nearest(at);
  }
  return out;
}

}  // namespace

ShowEditing::ShowEditing(RunDesk& desk, Run run)
    : desk_(desk),
      run_(std::move(run)),
      told_(run_.state, run_.show_file),
      wanted_(run_.attendance),
      plays_(run_.attendance) {
  watch_.watch(run_.planned.loaded.files);
  playing_.plan = std::make_shared<const Plan>(run_.planned.plan());
  playing_.rig = std::make_shared<const Rig>(run_.rig);
  stands_.emplace(run_.planned.plan());
  if (auto whole = config::load_show(run_.show_file)) {
    everybody_.performers = std::move(whole->show.performers);
    everybody_.understudies = std::move(whole->show.understudies);
  } else {
    everybody_.performers = run_.planned.loaded.show.performers;
  }
  add_orders(desk);
}

ShowEditing::~ShowEditing() { stop_work(); }

void ShowEditing::stop_work() {
  given_up_.store(true);
  way_given_up_.store(true);
  if (work_.valid()) work_.wait();
  way_.reset();  // waits
}

void ShowEditing::tell(RunEvent::Kind kind, std::string text) { desk_.tell({kind, std::move(text)}); }

void ShowEditing::keep(const Status<>& written) {
  if (!written) tell(RunEvent::Kind::note, "not on the disk, and lost with this run: " + written.error().message);
}

// ---- prepared beside the show

void ShowEditing::drop_coming() {
  way_given_up_.store(true);
  way_.reset();  // waits: it reads what is coming
  coming_.reset();
  take_ = placed_ = false;
}

/// That somebody is absent is no wish.
void ShowEditing::forget_wishes() {
  wanted_.covers = plays_.covers;
  wanted_.repaired = plays_.repaired;
}

void ShowEditing::plan_again(std::string why) {
  why_ = std::move(why);
  again_ = true;
  given_up_.store(true);
  error_.clear();
}

void ShowEditing::look(const DeskView& view, RunDesk& /*desk*/) {
  if (is_ready(work_)) finish();
  if (watch_.changed(view.show.at)) plan_again("the show's files have changed");
  if (again_ && !work_.valid() && !handing_over_ && playing_.wires != nullptr) start();
}

void ShowEditing::start() {
  if (take_) tell(RunEvent::Kind::note, "something has changed again: take was taken back");
  drop_coming();
  again_ = false;
  given_up_.store(false);
  PlanOrder order;
  order.show = run_.show_file;
  made_with_ = wanted_;
  wanted_.put_into(order.absent, order.covers);
  order.output = (run_.state / "coming.plan").string();
  work_ = std::async(std::launch::async,
                     [this, order, playing = playing_] { return prepare_show(order, playing, given_up_); });
}

void ShowEditing::finish() {
  auto made = work_.get();
  work_ = {};
  if (!made && made.error().kind == ErrorKind::interrupted) {
    again_ = true;
    return;
  }
  if (again_) return;
  if (!made) {
    error_ = std::move(made).error().message;
    forget_wishes();  // or the next change of the file would be wrong, too
    return tell(RunEvent::Kind::note, fmt::format("{}, and nothing is changed by it:\n{}", why_, error_));
  }
  coming_ = std::move(made).value();
  // Who is new to the list of files matters from now on, taken or not.
  watch_.watch(coming_->loaded.files);
  tell(RunEvent::Kind::note,
       fmt::format("changed: {} ({}); take takes it, discard forgets it", coming_->changes.text(), why_));
}

// ---- taken

void ShowEditing::begin(const ShowOnWires& wires) {
  playing_.wires = &wires;
  playing_.schedule = &*wires.schedule;
}

std::unique_ptr<ComingPlan> ShowEditing::wanted(const ShowState& state) {
  if (!take_ || !coming_ || handing_over_ || again_) return nullptr;
  const bool stands = state.phase == Phase::stands || state.phase == Phase::finished;
  if (!stands || state.reset.state != controller::Rehearsal::ResetState::none) return nullptr;
  if (stands_->until(state.position) != state.position) return nullptr;
  const ComingShow& coming = *coming_;
  const auto plays = controller::cue_plays(run_.planned.loaded.show, *playing_.plan);
  const Instant to = same_place(*playing_.plan, plays, coming.plan, coming.wires->plays, coming.stands, state.position,
                                state.active, state.standby);
  const std::vector<CellIndex> goals = controller::cells_at(coming.plan, to);
  const std::vector<CellIndex> cells = cells_from(*playing_.plan, state.position, coming.plan, goals);
  if (placed_ || cells == goals) return hand_over(state.position, to, nullptr);
  if (way_ && (way_->from != state.position || way_->to != to)) {
    way_given_up_.store(true);
    way_.reset();
  }
  if (!way_) {
    way_given_up_.store(false);
    way_.emplace(Way{state.position, to, {}, {}});
    way_->planned = std::async(std::launch::async, [this, &coming, cells, to] {
      return plan_way(coming.loaded.show, coming.plan, cells, to, std::max(1.0, run_.count_in_counts), way_given_up_);
    });
  }
  if (!is_ready(way_->planned)) return nullptr;
  const Result<Plan> way = way_->planned.get();
  way_.reset();
  if (way) return hand_over(state.position, to, &*way);
  take_ = false;
  tell(RunEvent::Kind::alarm,
       fmt::format("not taken: no reset move was found from here to the places of the new plan: {} "
                   "(take it at another place; or send people there and say take placed)",
                   way.error().message));
  return nullptr;
}

std::unique_ptr<ComingPlan> ShowEditing::hand_over(Instant from, Instant to, const Plan* way) {
  auto out = std::make_unique<ComingPlan>(
      ComingPlan{std::move(coming_->wires), coming_->loaded.show.tempo, coming_->stands, coming_->limits, from, to});
  if (way != nullptr) {
    controller::CueSchedule& schedule = *out->wires->schedule;
    out->way = schedule.add(controller::build_reset(coming_->loaded.show, *way, coming_->loaded.rig, schedule, true));
    out->walks = std::make_shared<const Plan>(*way);
    walks_ = way_text(*way);
  }
  handing_over_ = true;
  return out;
}

void ShowEditing::end() {
  stop_work();
  playing_.wires = nullptr;
}

void ShowEditing::not_taken() {
  handing_over_ = false;
  // It is made again, from what is kept of it, and taken where the show stands next.
  plan_again(why_);
  tell(RunEvent::Kind::note, "not taken: the show went on at that very moment; say take when it is ready again");
}

void ShowEditing::taken(const ShowOnWires& plays) {
  handing_over_ = false;
  ComingShow& coming = *coming_;
  const std::string text = coming.changes.text();
  keep(told_.add(coming.changes.people));
  run_.planned.loaded = std::move(coming.loaded);
  run_.planned.planned = {};
  run_.planned.planned.plan = std::move(coming.plan);
  run_.planned.films.reset();
  for (std::size_t n = 0; n < run_.rig.nodes.size(); ++n) {
    run_.rig.nodes[n].channels = run_.planned.loaded.rig.nodes[n].channels;
  }
  everybody_ = std::move(coming.everybody);
  playing_.plan = std::make_shared<const Plan>(run_.planned.plan());
  playing_.rig = std::make_shared<const Rig>(run_.rig);
  playing_.schedule = &*plays.schedule;
  plays_ = made_with_;
  stands_.emplace(*playing_.plan);
  drop_coming();
  keep(keep_taken(run_.state, run_.show_file, playing_.plan->show_hash, plays_, run_.state / "coming.plan"));
  if (on_taken_) on_taken_();
  desk_.plan_taken();
  tell(RunEvent::Kind::note, fmt::format("taken: {}; {} to be told", text, told_.size()));
  if (!walks_.empty()) tell(RunEvent::Kind::reset, std::exchange(walks_, {}));
}

EditView ShowEditing::view() const {
  EditView out;
  out.state = handing_over_ || (take_ && coming_) ? EditView::State::taking
              : work_.valid() || again_           ? EditView::State::planning
              : coming_                           ? EditView::State::waits
              : !error_.empty()                   ? EditView::State::wrong
                                                  : EditView::State::none;
  out.text = coming_ ? why_ : error_;
  if (coming_) {
    out.transitions = coming_->changes.transitions;
    out.people = coming_->changes.people.size();
  }
  out.untold = told_.people();
  for (const std::string& id : wanted_.absent) out.absent.push_back({id, plays_as(id)});
  return out;
}

std::string ShowEditing::plays_as(const std::string& absent) const {
  if (const auto cover = plays_.covers.find(absent); cover != plays_.covers.end()) return cover->second;
  return plays_.repaired.contains(absent) ? "repaired" : "";
}

}  // namespace footlight::app
