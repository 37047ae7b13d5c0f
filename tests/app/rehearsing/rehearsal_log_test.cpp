// SPDX-License-Identifier: Apache-2.0
#include "app/rehearsing/rehearsal_log.hpp"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include "app/rehearsing/rehearsal_report.hpp"
#include "tests/support/small_show.hpp"
#include "tests/support/temporary_folder.hpp"

namespace footlight::app {
namespace {

using Kind = RehearsalEntry::Kind;
using Phase = controller::Rehearsal::Phase;

class RehearsalLogTest : public ::testing::Test {
 protected:
  RehearsalLogTest() : small_(tests::random_show(6, 6, 4, 3, 2, 1)) {
    small_.show.cues = {tests::cue_of("1", 0), tests::cue_of("2", 1), tests::cue_of("3", 2)};
    small_.show.performers[0].name = "Ana";
    small_.show.performers[1].name = "Eva <1>";
    small_.show.performers[1].absent = true;
    begin();
  }
  void begin() {
    desk_ = std::make_unique<RunDesk>(small_.show, small_.plan);
    log_ =
        std::make_unique<RehearsalLog>(small_.show, desk_->orders().plays(), folder_.path(), [this] { return now_s_; });
    log_->open();
    desk_->add(*log_);
    desk_->add(log_->note_verb());
    desk_->add(log_->notes_verb());
    view_ = {};
    view_.show.standby = 0;
    look();
  }
  void look() { (void)desk_->look(view_); }
  void at(Phase phase, int active, int standby, double position_s, double passes_s) {
    now_s_ += passes_s;
    view_.show.phase = phase;
    view_.show.active = active;
    view_.show.standby = standby;
    view_.show.position = instant_at(position_s);
    look();
  }
  /// Counted in, held in the middle, on to its end; then sent back, and cue 2 is called off in its count-in.
  void rehearse() {
    at(Phase::counts_in, 0, 1, 0, 1);
    at(Phase::runs, 0, 1, 0, 2);
    at(Phase::runs, 0, 1, 2, 2);
    desk_->say("note Ana too late", {});
    at(Phase::stands, 0, 1, 2.5, 0.5);
    at(Phase::runs, 0, 1, 2.5, 10);
    at(Phase::stands, -1, 1, 4, 1.5);
    view_.show.reset = {controller::Rehearsal::ResetState::ready, 1, instant_at(4), instant_at(0)};
    at(Phase::resets, -1, 1, 4, 3);
    view_.show.reset = {};
    at(Phase::stands, -1, 0, 0, 5);
    at(Phase::counts_in, 0, 1, 0, 1);
    at(Phase::stands, -1, 0, 0, 1);
  }
  [[nodiscard]] RehearsalReport report() const {
    return report_of(small_.show, desk_->orders().plays(), log_->entries(), nullptr);
  }
  test::TemporaryFolder folder_;
  tests::SmallShow small_;
  double now_s_ = 1'700'000'000;
  std::unique_ptr<RunDesk> desk_;
  std::unique_ptr<RehearsalLog> log_;
  DeskView view_;
};

TEST_F(RehearsalLogTest, WritesDownWhatTheShowDidAndWhatWasSaid) {
  rehearse();
  std::string told;
  for (const RehearsalEntry& entry : log_->entries()) {
    told += std::string(to_text(entry.kind)) + (entry.cue.empty() ? "" : " " + entry.cue) + "; ";
  }
  EXPECT_EQ(told, "begun; start 1; note 1; hold 1; goes-on 1; end 1; reset 1; start 1; hold 1; ");
  const RehearsalReport all = report();
  EXPECT_EQ(all.cues[0].starts, 2);
  EXPECT_EQ(all.cues[0].ends, 1);
  EXPECT_EQ(all.cues[0].holds, (std::vector<double>{6, 1}));
  EXPECT_EQ(all.cues[0].goes_on, 1);
  EXPECT_EQ(all.cues[0].resets, 1);
  EXPECT_NEAR(all.cues[0].run_s, 4.5 + 1.5 + 1, 1e-9);
  EXPECT_EQ(all.cues[1].starts, 0);
  ASSERT_EQ(all.cues[0].notes.size(), 1U);
  EXPECT_EQ(note_line(all.cues[0].notes[0]), "count 5, cue 1, Ana: too late");
  EXPECT_EQ(all.absent, std::vector<std::string>{"Eva <1>"});
}

TEST_F(RehearsalLogTest, WhoIsAbsentByTheDesksWordIsInTheReportAlsoAfterAKill) {
  const std::string ana = small_.show.performers[0].id;
  view_.edit.absent = {{ana, ""}};
  look();
  view_.edit.absent = {{ana, "repaired"}};
  look();
  view_.edit.absent.clear();  // she has come
  look();
  EXPECT_EQ(report().absent, (std::vector<std::string>{"Eva <1>", "Ana"}));
  begin();
  EXPECT_EQ(report().absent, (std::vector<std::string>{"Eva <1>", "Ana"}));
}

TEST_F(RehearsalLogTest, AProgramThatIsKilledLosesNothingThatItHasSaid) {
  rehearse();
  EXPECT_TRUE(log_->flush());
  {
    std::ofstream cut(folder_.path() / RehearsalLog::kFile, std::ios::app);
    cut << R"({"what": "note", "te)";
  }
  const std::size_t before = log_->entries().size();
  begin();
  EXPECT_EQ(log_->entries().size(), before + 1) << "and one that says that it began again";
  desk_->say("note all smile", {});
  begin();
  EXPECT_EQ(log_->entries().size(), before + 3);
  EXPECT_EQ(report().programs, 3);
  EXPECT_EQ(report().cues[0].notes.size(), 2U);
}

TEST_F(RehearsalLogTest, TheRehearsalOfAnotherShowIsPutAside) {
  rehearse();
  small_.show.title = "another";
  begin();
  EXPECT_EQ(log_->entries().size(), 1U);
  int aside = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder_.path())) {
    aside += file.path().filename().string().starts_with("rehearsal-") ? 1 : 0;
  }
  EXPECT_EQ(aside, 1);
}

TEST_F(RehearsalLogTest, AtTheEndItTakesANameOfItsOwn) {
  const std::string stem = log_->close();
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / (stem + ".jsonl")));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / RehearsalLog::kFile));
}

TEST_F(RehearsalLogTest, AFolderThatTakesNothingCostsTheFileAlone) {
  RehearsalLog log(small_.show, desk_->orders().plays(), "/nonexistent/folder", [] { return 1.0; });
  log.open();
  EXPECT_EQ(log.trouble(), "cannot write '/nonexistent/folder/rehearsal.jsonl': No such file or directory");
  EXPECT_EQ(log.entries().size(), 1U);
}

TEST_F(RehearsalLogTest, ADiskThatTakesNoMoreIsToldOnceAndTheRehearsalGoesOn) {
  struct Ear final : Surface {
    void look(const DeskView& /*view*/, RunDesk& /*desk*/) override {}
    void told(const RunEvent& event) override { notes += event.kind == RunEvent::Kind::note ? 1 : 0; }
    [[nodiscard]] bool listens() const override { return true; }
    int notes = 0;
  } ear;
  desk_->add(ear);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto signal_before = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit none{0, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &none), 0);
  rehearse();
  EXPECT_TRUE(log_->flush());
  look();
  (void)setrlimit(RLIMIT_FSIZE, &before);
  (void)std::signal(SIGXFSZ, signal_before);
  EXPECT_EQ(log_->trouble(),
            "the rehearsal is not kept in '" + (folder_.path() / "rehearsal.jsonl").string() + "': File too large");
  EXPECT_EQ(ear.notes, 1);
  EXPECT_EQ(report().cues[0].starts, 2);
}

TEST_F(RehearsalLogTest, TheReportIsTextAndJsonAndAPage) {
  rehearse();
  desk_->say("note <b>all</b> \xff smile", {});
  const RehearsalReport all = report();
  const std::string text = rehearsal_text(all);
  EXPECT_NE(text.find("cue      starts  ends  held at count  resets  time  GO to last lamp\n"
                      "1 cue 1       2     1           6, 1       1  0:07                -\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("absent: Eva <1>\n"), std::string::npos) << text;
  EXPECT_NE(text.find("  count 5, cue 1, Ana: too late\n"), std::string::npos) << text;
  const auto json = nlohmann::json::parse(rehearsal_json(all));
  EXPECT_EQ(json["cues"][0]["notes"][0]["whom"], "Ana");
  EXPECT_EQ(json["cues"][0]["holds_at_count"], (std::vector<double>{6, 1}));
  const std::string page = rehearsal_html(all);
  EXPECT_EQ(page.find("<b>"), std::string::npos) << "what somebody typed is text";
  EXPECT_NE(page.find("&lt;b&gt;all&lt;/b&gt;"), std::string::npos) << page;
  EXPECT_NE(page.find("Eva &lt;1&gt;"), std::string::npos);
}

TEST_F(RehearsalLogTest, TheReportTellsHowLateLampsWere) {
  rehearse();
  LiveReport live;
  live.late_latches = 3;
  live.cues = {{"1", "", 16.6, 2}, {"2", "", 0, 0}, {"3", "", 0, 0}};
  live.buses.emplace_back().latch.worst_ms = 1.25;
  const std::string text = rehearsal_text(report_of(small_.show, desk_->orders().plays(), log_->entries(), &live));
  EXPECT_NE(text.find("3 switches of lamps more than 1 ms late, the worst 1.250 ms\n"
                      "2 nodes were not right at the end of a cue\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("17 ms"), std::string::npos) << text;
}

TEST_F(RehearsalLogTest, NotesAreListedInTheirOrder) {
  struct Ear final : Surface {
    void look(const DeskView& /*view*/, RunDesk& /*desk*/) override {}
    void told(const RunEvent& event) override { last = event.text; }
    [[nodiscard]] bool listens() const override { return true; }
    std::string last;
  } ear;
  desk_->add(ear);
  desk_->say("notes", {});
  EXPECT_EQ(ear.last, "no notes");
  desk_->say("note Ana too late", {});
  EXPECT_EQ(ear.last, "count 1, cue 1, Ana: too late");
  desk_->say("note B2 dark", {});
  desk_->say("notes", {});
  EXPECT_EQ(ear.last, "count 1, cue 1, Ana: too late\ncount 1, cue 1, B2: dark");
}

}  // namespace
}  // namespace footlight::app
