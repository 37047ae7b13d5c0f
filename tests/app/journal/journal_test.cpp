// SPDX-License-Identifier: Apache-2.0
#include "app/journal/journal.hpp"

#include <functional>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/surfaces/run_desk.hpp"
#include "app/surviving/surviving.hpp"
#include "core/machine_time.hpp"
#include "tests/support/small_show.hpp"
#include "tests/support/temporary_folder.hpp"

namespace footlight::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::string> lines_of(const JournalReading& reading) {
  std::vector<std::string> lines;
  for (const JournalEntry& entry : reading.entries) {
    lines.push_back(entry.kind + "|" + entry.order + "|" + entry.who + "|" + entry.text + (entry.refused ? "|no" : ""));
  }
  return lines;
}

void wait_for(const std::function<bool()>& what) {
  for (int i = 0; i < 2000 && !what(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_TRUE(what());
}

struct Ears final : Surface {
  void look(const DeskView& /*view*/, RunDesk& /*desk*/) override {}
  void told(const RunEvent& event) override { heard.push_back(json_of(event)); }
  [[nodiscard]] bool listens() const override { return true; }
  std::vector<std::string> heard;
};

class JournalTest : public ::testing::Test {
 protected:
  JournalTest() : small_(tests::random_show(6, 6, 4, 3, 2, 1)), desk_(small_.show, small_.plan) {}
  JournalRun run() const { return {0, {}, "1.2", "/shows/a.yaml", "abc", {}, 7, {}, {}}; }
  DeskView view(double position_s, bool runs) const {
    DeskView view;
    view.show.position = instant_at(position_s);
    view.show.phase = runs ? controller::Rehearsal::Phase::runs : controller::Rehearsal::Phase::stands;
    view.show.where.position = instant_at(position_s);
    if (runs) {
      view.show.where.cue = 1;
      view.show.where.waits = false;
      view.show.where.runs_since = view.show.at;
    }
    return view;
  }
  static RunEvent answer(const std::string& order, const std::string& text, bool refused = false) {
    RunEvent event{RunEvent::Kind::answer, text};
    event.order = order;
    event.who = {controller::GoSource::network, "osc 10.0.0.4"};
    event.refused = refused;
    return event;
  }
  JournalReading read(std::int64_t run = 0) const {
    auto reading = read_journal(path_, run);
    EXPECT_TRUE(reading) << reading.error().message;
    return reading ? std::move(reading).value() : JournalReading{};
  }

  test::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "journal.sqlite";
  tests::SmallShow small_;
  RunDesk desk_;
};

TEST_F(JournalTest, HasWhatHappenedAndWhoSaidSoAndThePlan) {
  {
    Journal journal(path_, run());
    journal.look(view(4, false), desk_);
    journal.told(answer("go", "the cue starts"));
    journal.told(answer("jump cue 9", "no cue \"9\"", true));
    journal.told({RunEvent::Kind::alarm, "bus \"left\" is down"});
    journal.health_is("bus \"left\": silent: left-1");
    journal.plan_is("def");
    journal.close(kOver);
  }
  const JournalReading reading = read();
  ASSERT_EQ(reading.runs.size(), 1U);
  EXPECT_EQ(reading.runs[0].plan, "abc");
  EXPECT_EQ(reading.runs[0].show, "/shows/a.yaml");
  EXPECT_EQ(reading.runs[0].epoch, 7U);
  EXPECT_EQ(reading.runs[0].machine_start, machine_start());
  EXPECT_EQ(reading.runs[0].how, "over");
  EXPECT_TRUE(reading.runs[0].ended);
  EXPECT_THAT(lines_of(reading),
              ElementsAre("answer|go|osc 10.0.0.4|the cue starts", "answer|jump cue 9|osc 10.0.0.4|no cue \"9\"|no",
                          "alarm|||bus \"left\" is down", "health|||bus \"left\": silent: left-1", "plan|||def"));
  EXPECT_EQ(reading.entries[0].position, instant_at(4));
}

TEST_F(JournalTest, ThePlaceIsWrittenAtEveryChangeAndOnceASecondWhileItMoves) {
  const auto places = [&] {
    auto database = config::Database::open(path_.string(), config::Database::Use::read);
    auto count = database->prepare("SELECT count(*) FROM places");
    return count.step() ? count.integer(0).value_or(-1) : -1;
  };
  {
    Journal journal(path_, run());
    for (int i = 0; i < 50; ++i) journal.look(view(4, false), desk_);
    for (int i = 0; i < 101; ++i) {
      DeskView now = view(4, true);
      now.show.where.position += milliseconds(20 * i);
      now.show.at += milliseconds(20 * i);
      journal.look(now, desk_);
    }
  }
  EXPECT_EQ(places(), 1 + 3) << "stands; begins; one and two seconds later";
  const auto place = read().last_place;
  ASSERT_TRUE(place);
  EXPECT_EQ(place->where.position, instant_at(6));
  EXPECT_EQ(place->where.cue, 1U);
  EXPECT_TRUE(place->where.runs_since);
}

TEST_F(JournalTest, EverythingOfAPlaceIsReadAsItWasWritten) {
  Place place;
  place.where.position = instant_at(4.25);
  place.where.cue = 2;
  place.where.waits = false;
  place.where.runs_since = instant_at(99);
  place.where.percent = 80;
  place.where.hold_at = instant_at(5);
  place.where.step_to = instant_at(6);
  place.where.loop = {instant_at(3), instant_at(7)};
  place.at = seconds(100);
  place.over = true;
  place.in_reset = true;
  place.time = {false, true};
  place.emergency_hold = true;
  place.readiness = R"({"armed": true})";
  {
    auto file = JournalFile::open(path_);
    ASSERT_TRUE(file) << file.error().message;
    ASSERT_TRUE(file->begin(run()));
    ASSERT_TRUE(file->write({}, std::vector{place}));
  }
  const auto again = read().last_place;
  ASSERT_TRUE(again);
  EXPECT_EQ(again->where.position, place.where.position);
  EXPECT_EQ(again->where.cue, place.where.cue);
  EXPECT_EQ(again->where.waits, place.where.waits);
  EXPECT_EQ(again->where.runs_since, place.where.runs_since);
  EXPECT_EQ(again->where.percent, place.where.percent);
  EXPECT_EQ(again->where.hold_at, place.where.hold_at);
  EXPECT_EQ(again->where.step_to, place.where.step_to);
  ASSERT_TRUE(again->where.loop);
  EXPECT_EQ(again->where.loop->from, instant_at(3));
  EXPECT_EQ(again->where.loop->to, instant_at(7));
  EXPECT_EQ(again->at, place.at);
  EXPECT_TRUE(again->over);
  EXPECT_TRUE(again->in_reset);
  EXPECT_EQ(again->time, place.time);
  EXPECT_TRUE(again->emergency_hold);
  EXPECT_EQ(again->readiness, place.readiness);
}

TEST_F(JournalTest, WhatIsSaidOfTimeAHoldOrReadinessIsAPlaceOfItsOwnThoughNothingMoves) {
  const auto last = [&] {
    const auto reading = read_journal(path_);  // its own thread may be making it
    return reading ? reading->last_place.value_or(Place{}) : Place{};
  };
  Journal journal(path_, run());
  DeskView now = view(4, false);
  journal.look(now, desk_);
  const auto seen = [&](const auto& there) {
    journal.look(now, desk_);
    wait_for([&] { return there(last()); });
  };
  now.show.time.armed = false;
  seen([](const Place& place) { return place.time.on && !place.time.armed; });
  now.show.time.on = false;
  seen([](const Place& place) { return !place.time.on; });
  now.emergency_hold = true;
  seen([](const Place& place) { return place.emergency_hold; });
  now.readiness.outlives = "armed";
  seen([](const Place& place) { return place.readiness == "armed"; });
}

TEST_F(JournalTest, ADiskThatTakesNothingIsAnAlarmAndTheShowGoesOn) {
  Ears ears;
  desk_.add(ears);
  // A file of 64 KiB and no more: what a full disk says to a writer, without a disk.
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small{65'536, before.rlim_max};
  const auto old = ::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  Journal journal(path_, run());
  const std::string long_text(2000, 'x');
  wait_for([&] {
    journal.told({RunEvent::Kind::note, long_text});
    journal.look(view(0, false), desk_);
    return !ears.heard.empty();
  });
  EXPECT_THAT(ears.heard, ElementsAre("{\"alarm\":\"the journal '" + path_.string() +
                                      "' takes nothing: disk I/O error; the show goes on\"}"));
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  for (int i = 0; i < 5000; ++i) journal.told({RunEvent::Kind::note, "flood"});
  wait_for([&] {
    journal.look(view(0, false), desk_);
    return ears.heard.size() == 2;
  });
  EXPECT_THAT(ears.heard[1], HasSubstr("{\"note\":\"the journal is written again; "));
  journal.told({RunEvent::Kind::note, "after"});
  journal.close(kOver);
  (void)::signal(SIGXFSZ, old);
  const auto reading = read();
  EXPECT_EQ(reading.entries.back().text, "after");
  EXPECT_GT(reading.entries.size(), Journal::kMostWaiting / 2);
}

TEST_F(JournalTest, AFolderThatIsNotThereIsAnAlarmAndNothingElse) {
  Journal journal(folder_.path() / "no" / "journal.sqlite", run());
  Ears ears;
  desk_.add(ears);
  wait_for([&] {
    journal.look(view(0, false), desk_);
    return !ears.heard.empty();
  });
  EXPECT_THAT(ears.heard, ElementsAre(HasSubstr("takes nothing: unable to open database file; the show goes on")));
}

TEST_F(JournalTest, AFileThatIsSomethingElseIsNotTouched) {
  const std::string plan =
      folder_.write("journal.sqlite", std::string("SQLite format 3\0nothing", 23) + std::string(600, 'x'));
  EXPECT_FALSE(JournalFile::open(path_));
  EXPECT_FALSE(read_journal(path_));
  auto database = config::Database::open(folder_ / "other.sqlite", config::Database::Use::write);
  ASSERT_TRUE(database && database->execute("CREATE TABLE a(b)"));
  const auto reading = read_journal(folder_ / "other.sqlite");
  ASSERT_FALSE(reading);
  EXPECT_EQ(reading.error().message,
            "cannot read the journal '" + (folder_ / "other.sqlite") + "': it is no journal of a run");
}

// ---- the place of a run that was cut off

class CutOffTest : public JournalTest {
 protected:
  /// @param how empty: killed
  void run_to(double position_s, const std::string& how, const std::string& plan = "abc") {
    auto file = JournalFile::open(path_);
    ASSERT_TRUE(file);
    JournalRun one = run();
    one.plan = plan;
    one.machine_start = machine_start();
    ASSERT_TRUE(file->begin(one));
    if (position_s >= 0) {
      Place place;
      place.where.position = instant_at(position_s);
      ASSERT_TRUE(file->write({}, std::vector{place}));
    }
    if (how.empty()) return;
    ASSERT_TRUE(file->end(seconds(1), how));
  }
  std::optional<CutOff> find(const std::string& plan = "abc") {
    auto found = find_cut_off(path_, plan, told_);
    if (!found) {
      told_ = found.error().message;
      return std::nullopt;
    }
    return *found;
  }
  std::string told_;
};

TEST_F(CutOffTest, IsThatOfTheLastRunThatDied) {
  run_to(1, "over");
  run_to(3, "");
  const auto cut = find();
  ASSERT_TRUE(cut);
  EXPECT_EQ(cut->place.where.position, instant_at(3));
  EXPECT_TRUE(cut->same_start);
}

TEST_F(CutOffTest, WhatDiedBeforeItsFirstLampHidesNothing) {
  run_to(3, "");
  run_to(-1, "");
  run_to(-1, "bus \"left\": no such port");
  ASSERT_TRUE(find());
  EXPECT_EQ(find()->place.where.position, instant_at(3));
}

TEST_F(CutOffTest, ARunThatEndedByItsOwnWillIsNotTakenUpAndAnInterruptedOneIs) {
  EXPECT_FALSE(find());
  EXPECT_EQ(told_, "nothing to take up: there is no journal '" + path_.string() + "' yet");
  run_to(3, kQuit);
  EXPECT_FALSE(find());
  EXPECT_EQ(told_, "nothing to take up: the last run has ended (quit)");
  run_to(4, "interrupted");
  EXPECT_TRUE(find());
}

TEST_F(CutOffTest, AnotherPlansPlacesMeanNothing) {
  run_to(3, "", "0123456789abcdef");
  EXPECT_FALSE(find());
  EXPECT_EQ(
      told_,
      "--resume: the run that was cut off led another plan (0123456789ab..., this one is abc...): its places mean "
      "nothing here (without --resume the show begins at the top)");
}

TEST_F(CutOffTest, TheLastPlanThatWasTakenWhileItRanIsTheOneThatCounts) {
  {
    Journal journal(path_, run());
    journal.look(view(4, false), desk_);
    journal.plan_is("def");
    journal.close("killed");
  }
  EXPECT_FALSE(find("abc"));
  EXPECT_TRUE(find("def"));
}

}  // namespace
}  // namespace footlight::app
