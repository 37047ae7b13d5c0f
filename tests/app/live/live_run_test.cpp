// SPDX-License-Identifier: Apache-2.0
#include "app/live/live_run.hpp"

#include <algorithm>
#include <atomic>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "controller/stands.hpp"
#include "sim/endpoints/served_rig.hpp"
#include "tests/support/plan_builder.hpp"
#include "tests/support/small_show.hpp"
#include "tests/support/temporary_folder.hpp"

namespace footlight::app {
namespace {

using tests::SmallShow;

/// A show of four seconds on three buses that a thread serves on pseudo-terminals and a port, as `footlight sim` does.
class LiveRunTest : public ::testing::Test {
 protected:
  LiveRunTest() {
    small_ = tests::random_show(8, 6, 12, 1, 2, 5);
    small_.rig = tests::lamps_everywhere(small_.show.stage.grid,
                                         {BusKind::serial, BusKind::modbus_rtu, BusKind::modbus_tcp}, 115'200, 8);
    sim::Serving serving;
    serving.folder = folder_.path();
    auto served = sim::ServedRig::open(small_.rig, serving, clock_, nullptr);
    EXPECT_TRUE(served);
    served_ = std::move(served).value();
    for (std::size_t b = 0; b < small_.rig.buses.size(); ++b) small_.rig.buses[b].url = served_->served()[b].url;
    server_ = std::thread([this] {
      while (!over_.load()) served_->step(milliseconds(20), [](Instant) {});
    });
  }
  ~LiveRunTest() override { stop_serving(); }
  void stop_serving() {
    over_.store(true);
    if (server_.joinable()) server_.join();
  }
  std::vector<drivers::Port> open() {
    std::vector<drivers::Port> ports;
    for (std::size_t b = 0; b < small_.rig.buses.size(); ++b) {
      auto port = drivers::open_port(small_.rig.buses[b], drivers::node_addresses(small_.rig, BusIndex::of(b)));
      EXPECT_TRUE(port) << port.error().message;
      if (port) ports.push_back(std::move(port).value());
    }
    return ports;
  }

  test::TemporaryFolder folder_;
  SteadyClock clock_;
  SmallShow small_;
  std::unique_ptr<sim::ServedRig> served_;
  std::atomic<bool> over_{false};
  std::thread server_;
};

TEST_F(LiveRunTest, EveryMarkerShowsTheLastSwitchInTheEnd) {
  const auto ports = open();
  LiveOptions options;
  options.go = true;
  std::vector<std::string> moments;
  options.moment = [&](const std::string& line) { moments.push_back(line); };
  NodeBoard board(small_.rig.nodes.size());
  EXPECT_EQ(board.at(0), NodeBoard::View{}) << "nothing is known of a node that has said nothing";
  options.nodes = &board;
  const auto report = live_run(small_.show, small_.plan, small_.rig, ports, options);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->unconfirmed, 0U);
  EXPECT_EQ(report->deaf, 0U);
  EXPECT_EQ(moments.size() + 1, report->switches) << "all but the opening";
  for (const LiveBusReport& bus : report->buses) {
    EXPECT_GT(bus.deliveries, 0U) << bus.name;
    EXPECT_GT(bus.latch.count, 0U) << bus.name;
  }
  for (std::size_t n = 0; n < board.size(); ++n) {
    EXPECT_EQ(board.at(n).shown, report->switches - 1) << n;
    EXPECT_EQ(board.at(n).flags, NodeBoard::kRight | NodeBoard::kSameChecks) << n;
  }
  stop_serving();
  for (std::size_t n = 0; n < small_.rig.nodes.size(); ++n) {
    for (std::size_t c = 0; c < small_.rig.nodes[n].channels.size(); ++c) {
      EXPECT_EQ(served_->rig().shown(NodeIndex::of(n), static_cast<int>(c)), report->floor[n][c]) << n << ":" << c;
    }
  }
}

TEST_F(LiveRunTest, WiresThatAreGoneAreToldWithTheirReasonAndNothingOnThemIsConfirmedAnyMore) {
  const auto ports = open();
  LiveOptions options;
  NodeBoard board(small_.rig.nodes.size());
  options.nodes = &board;
  std::vector<BusView> last;
  bool served = true;
  const auto all = [&](auto&& which) { return std::ranges::all_of(last, which); };
  options.desk = [&](const DeskView& view) {
    DeskWishes wishes;
    last = view.buses;
    if (!view.roll_called) return wishes;
    if (served && all([](const BusView& bus) { return bus.unconfirmed == 0 && bus.trouble.empty(); })) {
      served = false;
      stop_serving();
      served_.reset();
    }
    wishes.ends =
        !served && all([](const BusView& bus) { return !bus.trouble.empty() && bus.unconfirmed == bus.nodes; });
    return wishes;
  };
  const auto report = live_run(small_.show, small_.plan, small_.rig, ports, options);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->unconfirmed, small_.rig.nodes.size());
  for (const BusView& bus : last) EXPECT_EQ(bus.load, std::nullopt) << "nobody has reckoned it";
  EXPECT_EQ(last[0].trouble.empty(), false);
  for (std::size_t n = 0; n < board.size(); ++n) {
    EXPECT_EQ(board.at(n).flags & (NodeBoard::kRight | NodeBoard::kSilent), NodeBoard::kSilent) << n;
  }
}

TEST_F(LiveRunTest, TheHeartGoesOnWhileTheDeskIsStuckAndSaysWhatTheCueThreadSays) {
  const auto ports = open();
  LiveOptions options;
  std::atomic<int> beats{0};
  std::atomic<bool> grew{true};
  Instant last = Instant::min();
  options.heartbeat = [&](const ShowState& state, bool) {
    grew.store(grew.load() && state.at >= last);
    last = state.at;
    beats.fetch_add(1);
  };
  int looks = 0;
  options.desk = [&](const DeskView&) {
    // A surface that takes its time, once: nobody beats for the desk.
    if (++looks == 1) {
      const int before = beats.load();
      while (beats.load() < before + 5) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    DeskWishes wishes;
    wishes.ends = looks > 3;
    return wishes;
  };
  const auto report = live_run(small_.show, small_.plan, small_.rig, ports, options);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_TRUE(grew.load());
}

TEST_F(LiveRunTest, WithoutGoTheOpeningStandsAndStopEndsIt) {
  const auto ports = open();
  std::atomic<bool> stop{false};
  LiveOptions options;
  options.stop = &stop;
  std::size_t unconfirmed = 99;
  options.ready = [&](std::size_t nodes) {
    unconfirmed = nodes;
    stop.store(true);
  };
  const auto report = live_run(small_.show, small_.plan, small_.rig, ports, options);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().kind, ErrorKind::interrupted);
  EXPECT_EQ(unconfirmed, 0U);
}

TEST_F(LiveRunTest, AfterAHoldAndTheWayBackEveryMarkerShowsTheOpeningAgain) {
  using Kind = controller::Command::Kind;
  using Phase = controller::Rehearsal::Phase;
  const auto ports = open();
  LiveOptions options;
  options.rehearsal = {0, milliseconds(1)};
  std::vector<std::string> resets;
  options.reset = [&](const std::string& line) { resets.push_back(line); };
  options.plan_way = [&](Instant from, Instant to, const std::atomic<bool>&) -> Result<Plan> {
    const auto cells = controller::cells_at(small_.plan, from);
    const auto goals = controller::cells_at(small_.plan, to);
    std::vector<std::vector<Mark>> tracks;
    for (std::size_t p = 0; p < cells.size(); ++p) {
      tracks.push_back({{kStart, cells[p]}, {instant_at(0.5), cells[p]}, {instant_at(1), goals[p]}});
    }
    Plan way = tests::plan_of(small_.plan.stage.grid, std::move(tracks));
    way.sections = {{"start", kStart, kStart, 9, {}, {}, {}}, {"places", instant_at(1), instant_at(1), 9, {}, {}, {}}};
    way.valid = true;
    return way;
  };
  // What an operator does when she sees that.
  int stage = 0;
  options.desk = [&](const DeskView& view) {
    const auto command = [&](Kind kind) {
      ++stage;
      DeskWishes wishes;
      wishes.commands.emplace_back().kind = kind;
      return wishes;
    };
    const ShowState& show = view.show;
    const bool ready = show.reset.state == controller::Rehearsal::ResetState::ready;
    if (stage == 0 && view.roll_called) return command(Kind::go);
    if (stage == 1 && show.position > instant_at(0.5)) return command(Kind::hold);
    if (stage == 2 && show.phase == Phase::stands) return command(Kind::back);
    if (stage == 3 && ready) return command(Kind::go);
    if (stage == 4 && show.phase == Phase::stands && show.position == instant_at(2)) return command(Kind::go);
    DeskWishes wishes;
    wishes.ends = stage == 5 && show.phase == Phase::stands && show.position == kStart && show.reset.id == 0 &&
                  std::ranges::all_of(view.buses, [](const BusView& bus) { return bus.unconfirmed == 0; });
    return wishes;
  };
  std::vector<controller::Outcome> outcomes;
  options.answered = [&](const Answer& answer) { outcomes.push_back(answer.outcome); };
  const auto report = live_run(small_.show, small_.plan, small_.rig, ports, options);
  ASSERT_TRUE(report) << report.error().message;
  using controller::Outcome;
  EXPECT_THAT(outcomes, testing::ElementsAre(Outcome::cue_started, Outcome::done, Outcome::done, Outcome::done,
                                             Outcome::walks_on, Outcome::reset_started));
  EXPECT_EQ(resets.size(), 1U);
  EXPECT_EQ(report->unconfirmed, 0U);
  stop_serving();
  std::size_t lit = 0;
  for (std::size_t n = 0; n < small_.rig.nodes.size(); ++n) {
    for (std::size_t c = 0; c < small_.rig.nodes[n].channels.size(); ++c) {
      EXPECT_EQ(served_->rig().shown(NodeIndex::of(n), static_cast<int>(c)), report->floor[n][c]) << n << ":" << c;
      lit += report->floor[n][c] != kDark ? 1 : 0;
    }
  }
  EXPECT_GE(lit, 12U) << "the opening";
}

/// Takes another plan as soon as the show stands after the roll call, with people elsewhere: one after the other.
class TwoChanges : public PlanChanges {
 public:
  TwoChanges(SmallShow& small, std::vector<Plan> plans) : small_(small), plans_(std::move(plans)) {}
  void begin(const ShowOnWires& wires) override {
    wires_ = &wires;
    before_ = &*wires.schedule;
  }
  std::unique_ptr<ComingPlan> wanted(const ShowState& state) override {
    if (!allowed || taken_ == plans_.size() || state.phase != controller::Rehearsal::Phase::stands ||
        state.reset.state != controller::Rehearsal::ResetState::none) {
      return nullptr;
    }
    const Plan& plan = plans_[taken_];
    auto made = put_beside(small_.show, plan, small_.rig, *wires_, *before_);
    EXPECT_TRUE(made) << made.error().message;
    auto coming =
        std::make_unique<ComingPlan>(ComingPlan{std::move(made).value(), small_.show.tempo, controller::Stands(plan)});
    coming->from = state.position;
    coming->to = instant_at(2);
    const auto cells = controller::cells_at(small_.plan, state.position);
    const auto goals = controller::cells_at(plan, coming->to);
    std::vector<std::vector<Mark>> tracks;
    for (std::size_t p = 0; p < cells.size(); ++p) {
      tracks.push_back({{kStart, cells[p]}, {instant_at(0.2), cells[p]}, {instant_at(0.5), goals[p]}});
    }
    Plan way = tests::plan_of(plan.stage.grid, std::move(tracks));
    way.sections = {{"start", kStart, kStart, 9, {}, {}, {}}, {"places", instant_at(1), instant_at(1), 9, {}, {}, {}}};
    way.valid = true;
    coming->way = coming->wires->schedule->add(
        controller::build_reset(small_.show, way, small_.rig, *coming->wires->schedule, true));
    return coming;
  }
  void taken(const ShowOnWires& plays) override {
    before_ = &*plays.schedule;
    small_.plan = plans_[taken_++];
  }
  void not_taken() override { ADD_FAILURE(); }
  void end() override { wires_ = nullptr; }

  bool allowed = false;
  [[nodiscard]] std::size_t count() const { return taken_; }

 private:
  SmallShow& small_;
  std::vector<Plan> plans_;
  const ShowOnWires* wires_ = nullptr;
  const controller::CueSchedule* before_ = nullptr;
  std::size_t taken_ = 0;
};

TEST_F(LiveRunTest, OtherPlansAreTakenWhileItRunsAndEveryMarkerShowsTheLastOneInTheEnd) {
  const auto ports = open();
  std::vector<Plan> plans{tests::random_show(8, 6, 12, 1, 2, 6).plan, tests::random_show(8, 6, 12, 1, 2, 7).plan};
  TwoChanges changes(small_, plans);
  LiveOptions options;
  options.rehearsal = {0, milliseconds(1)};
  options.changes = &changes;
  std::vector<std::string> moments;
  options.moment = [&](const std::string& line) { moments.push_back(line); };
  std::size_t confirmed = 0;
  // The desk confirms both ways and plays the second plan to its end.
  options.desk = [&](const DeskView& view) {
    changes.allowed = view.roll_called;
    DeskWishes wishes;
    const bool ready = view.show.reset.state == controller::Rehearsal::ResetState::ready;
    if (ready && confirmed < changes.count()) {
      ++confirmed;
      wishes.commands.emplace_back();
    }
    const bool there = confirmed == 2 && view.show.phase == controller::Rehearsal::Phase::stands && !ready;
    if (there && view.show.position == instant_at(2)) wishes.commands.emplace_back();
    wishes.nobody = view.show.phase == controller::Rehearsal::Phase::finished;
    return wishes;
  };
  const auto report = live_run(small_.show, small_.plan, small_.rig, ports, options);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(changes.count(), 2U);
  EXPECT_EQ(report->unconfirmed, 0U);
  EXPECT_EQ(report->deaf, 0U);
  stop_serving();
  std::size_t wrong = 0;
  for (std::size_t n = 0; n < small_.rig.nodes.size(); ++n) {
    for (std::size_t c = 0; c < small_.rig.nodes[n].channels.size(); ++c) {
      const LookIndex shown = served_->rig().shown(NodeIndex::of(n), static_cast<int>(c));
      wrong += shown == report->floor[n][c] ? 0 : 1;
      const CellIndex cell = small_.rig.nodes[n].channels[c].cell;
      const auto ends = controller::cells_at(plans[1], instant_at(4));
      EXPECT_EQ(shown != kDark, std::ranges::find(ends, cell) != ends.end()) << n << ":" << c;
    }
  }
  EXPECT_EQ(wrong, 0U);
}

TEST_F(LiveRunTest, APlanThatIsNotValidSendsNothing) {
  const auto ports = open();
  small_.plan.valid = false;
  const auto report = live_run(small_.show, small_.plan, small_.rig, ports, {});
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().kind, ErrorKind::refused);
  EXPECT_EQ(report.error().message, "the plan is not valid and never lights a marker");
}

}  // namespace
}  // namespace footlight::app
