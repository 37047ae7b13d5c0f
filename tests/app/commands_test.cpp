// SPDX-License-Identifier: Apache-2.0
//
// The commands as a user meets them: the built program, its words, its exit status, and what it leaves on the disk.
#include <chrono>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "config/plan_file.hpp"
#include "tests/support/program.hpp"
#include "tests/support/starter_show.hpp"
#include "tests/support/temporary_folder.hpp"

namespace footlight {
namespace {

using nlohmann::json;
using test::footlight;
using test::Ran;
using test::StarterShow;
using test::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using Names = std::vector<std::string>;

constexpr const char* kVideo = FOOTLIGHT_TEST_DATA "/moving_square_40x30_12_frames_10fps.avi";

TEST(CommandLine, TellsItsVersionAndItsCommands) {
  EXPECT_THAT(footlight({"--version"}).out, StartsWith("footlight "));
  const Ran help = footlight({"--help"});
  EXPECT_EQ(help.status, 0);
  EXPECT_EQ(help.err, "");
  for (const std::string command :
       {"new", "check", "plan", "measure", "why", "export", "sheets", "preview", "report", "diff", "dryrun", "dark"}) {
    EXPECT_THAT(help.out, HasSubstr("\n  " + command + " "));
    const Ran one = footlight({command, "--help"});
    EXPECT_EQ(one.status, 0);
    EXPECT_THAT(one.out, HasSubstr("Examples:\n  footlight " + command)) << command;
  }
}

TEST(CommandLine, WrongWordsAreInputErrors) {
  const Ran none = footlight({});
  EXPECT_EQ(none.status, 2);
  EXPECT_EQ(none.out, "");
  EXPECT_EQ(none.err, "error: A subcommand is required (footlight --help tells what there is)\n");
  const Ran typo = footlight({"plann", "show.yaml"});
  EXPECT_EQ(typo.status, 2);
  EXPECT_EQ(typo.err, "error: there is no command \"plann\" (did you mean \"plan\"?)\n");
  const Ran missing = footlight({"plan"});
  EXPECT_EQ(missing.status, 2);
  EXPECT_EQ(missing.err, "error: SHOW is required (footlight --help tells what there is)\n");
}

TEST(NewCommand, DoesNotTouchAFolderThatIsThere) {
  const TemporaryFolder folder;
  const Ran made = footlight({"new", folder.path().string()});
  EXPECT_EQ(made.status, 2);
  EXPECT_EQ(made.err, "error: '" + folder.path().string() + "' is there already (a new show wants a new folder)\n");
  EXPECT_EQ(folder.names(), Names{});
}

TEST_F(StarterShow, CarriesTheSchemaThatItsFirstLineNames) {
  EXPECT_THAT(folder_.read("s/show.yaml"), StartsWith("# yaml-language-server: $schema=show.schema.json\n"));
  EXPECT_EQ(json::parse(folder_.read("s/show.schema.json"))["additionalProperties"], false);
}

TEST_F(StarterShow, ChecksWithoutAWord) {
  for (const Ran& ran : {footlight({"check", show_}), footlight({"check", "--no-media", show_})}) {
    EXPECT_EQ(ran.status, 0);
    EXPECT_EQ(ran.err, "");
    EXPECT_THAT(ran.out, HasSubstr(show_ + ": no errors (12 performers, 3 sections, 3 cues)"));
  }
  EXPECT_EQ(json::parse(footlight({"check", show_, "--json"}).out)["ok"], true);
  EXPECT_EQ(files(), as_made_);
}

TEST_F(StarterShow, EveryErrorIsReportedWithItsPlace) {
  replace("clearance: 0.5 m", "clearence: 0.5 m");
  replace("tempo: 100", "tempo: 0");
  const Ran ran = footlight({"check", show_});
  EXPECT_EQ(ran.status, 2);
  EXPECT_EQ(ran.out, "");
  EXPECT_EQ(ran.err, show_ + ":12:3: error: stage.clearence: unknown key (did you mean \"clearance\"?)\n" + show_ +
                         ":21:16: error: music.tempo: \"0\" is out of range (1 to 1000)\n");
  EXPECT_EQ(footlight({"plan", show_}).status, 2);
  EXPECT_EQ(files(), as_made_);
}

TEST_F(StarterShow, AFilmThatCannotBeDecodedIsReportedAtItsSection) {
  folder_.write("s/film.mp4", "no film");
  replace("{cells: ring.csv}, start: count 25, hold: 8 counts",
          "{video: film.mp4}, start: count 25, duration: 8 counts");
  for (const char* command : {"check", "plan"}) {
    const Ran ran = footlight({command, show_});
    EXPECT_EQ(ran.status, 2);
    EXPECT_EQ(ran.err,
              show_ + ":26:5: error: sections[1].from.video: '" + folder_ / "s/film.mp4" +
                  "' cannot be decoded as a video (a whole file is needed: MP4, MOV, Matroska, WebM, AVI, Ogg, GIF or "
                  "MPEG, with a video stream)\n");
    EXPECT_EQ(ran.out, "");
  }
  EXPECT_EQ(footlight({"check", "--no-media", show_}).status, 0);
}

TEST_F(StarterShow, WhyTellsWhatLimitsAMoveByCueFormationCountOrTime) {
  ASSERT_EQ(footlight({"plan", show_}).status, 0);
  const std::string by_cue = footlight({"why", show_, "7", "2", "--json"}).out;
  const json told = json::parse(by_cue);
  EXPECT_EQ(told["formation"], "ring/1");
  EXPECT_EQ(told["valid"], true);
  EXPECT_EQ(told["one_more_count"]["planned"]["places_reached"], 12);
  EXPECT_EQ(by_cue, footlight({"why", show_, "7", "--formation", "ring/1", "--json"}).out);
  EXPECT_EQ(by_cue, footlight({"why", show_, "7", "--count", "20", "--json"}).out);
  EXPECT_EQ(by_cue, footlight({"why", show_, "7", "--time", "11.4", "--json"}).out);
  EXPECT_THAT(footlight({"why", show_, "7", "2"}).out, HasSubstr("performer 7 into ring/1, count 9 to 25: "));
}

TEST_F(StarterShow, WhyHelpsWithWrongNames) {
  ASSERT_EQ(footlight({"plan", show_}).status, 0);
  const auto wrong = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"why", show_});
    const Ran ran = footlight(words);
    EXPECT_EQ(ran.status, 2);
    EXPECT_EQ(ran.out, "");
    return ran.err;
  };
  EXPECT_EQ(wrong({"77", "2"}), "error: there is no performer \"77\" (did you mean \"7\"?)\n");
  EXPECT_EQ(wrong({"7", "22"}), "error: there is no cue \"22\" (did you mean \"2\"?)\n");
  EXPECT_EQ(wrong({"7", "--formation", "rong/1"}),
            "error: there is no formation \"rong/1\" (did you mean \"ring/1\"?)\n");
  EXPECT_EQ(wrong({"7", "1"}), "error: cue 1 is the opening form: nobody walks into it (ask for a later one)\n");
  EXPECT_EQ(wrong({"7", "--formation", "line/1"}),
            "error: formation \"line/1\" is the opening form: nobody walks into it (ask for a later one)\n");
  EXPECT_EQ(wrong({"7", "--count", "500"}),
            "error: nobody walks after count 49, at 28.800 s (arrow/1 is the last formation)\n");
  EXPECT_EQ(wrong({"7"}), "error: say which move: one of CUE, --formation, --count and --time\n");
  EXPECT_EQ(wrong({"7", "2", "--time", "3"}), "error: say which move: one of CUE, --formation, --count and --time\n");
}

TEST_F(StarterShow, PlansIntoAFileBesideTheShow) {
  const Ran ran = footlight({"plan", show_});
  EXPECT_EQ(ran.status, 0);
  EXPECT_EQ(ran.err, "note: wrote " + plan_ + "\n");
  EXPECT_THAT(ran.out, StartsWith("Twelve: 12 performers on 12 x 8 cells, "));
  EXPECT_THAT(ran.out, HasSubstr("\nring "));
  Names expected = as_made_;
  expected.push_back("show.plan");
  expected.push_back("show.stages");
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(files(), expected);
  EXPECT_EQ(footlight({"plan", show_, "--quiet"}).err, "");
}

TEST_F(StarterShow, AfterAChangeOnlyWhatDependsOnItIsPlannedAgain) {
  ASSERT_EQ(footlight({"plan", show_}).status, 0);
  const std::string before = folder_.read("s/show.plan");
  const Ran same = footlight({"plan", show_});
  EXPECT_THAT(same.err, HasSubstr("re-planned 0 of "));
  EXPECT_EQ(folder_.read("s/show.plan"), before);
  replace("pitch: 1 m", "pitch: 1.1 m");
  const Ran other = footlight({"plan", show_});
  EXPECT_THAT(other.err, Not(HasSubstr("re-planned 0 of ")));
  const std::string reused = folder_.read("s/show.plan");
  const Ran afresh = footlight({"plan", show_, "--afresh"});
  EXPECT_THAT(afresh.err, Not(HasSubstr("re-planned")));
  EXPECT_EQ(folder_.read("s/show.plan"), reused);
}

TEST_F(StarterShow, AbsentPeopleAreInNoPlanAndEveryCommandGoesOn) {
  const Ran ran = footlight({"plan", show_, "--absent", "3,5"});
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_THAT(ran.out, StartsWith("Twelve: 10 performers on 12 x 8 cells, "));
  EXPECT_THAT(ran.out, HasSubstr("performer 3 is absent: "));
  EXPECT_EQ(footlight({"dryrun", show_}).status, 0);
  EXPECT_EQ(footlight({"measure", show_}).status, 0);
  EXPECT_EQ(footlight({"export", show_, "--csv", folder_ / "out"}).status, 0);
  EXPECT_EQ(footlight({"why", show_, "7", "2"}).status, 0);
  const Ran gone = footlight({"why", show_, "3", "2"});
  EXPECT_EQ(gone.status, 2);
  EXPECT_THAT(gone.err, StartsWith("error: there is no performer \"3\" "));
  EXPECT_EQ(footlight({"plan", show_, "--absent", "77"}).err,
            "error: --absent: there is no performer \"77\" (did you mean \"7\"?)\n");
  EXPECT_EQ(footlight({"plan", show_, "--absent", "1,2,3,4,5,6,7,8,9,10,11,12"}).err,
            "error: --absent: nobody is left (somebody has to come)\n");
  // What is asked for once is not remembered: the show file says who does not come.
  EXPECT_THAT(footlight({"plan", show_}).out, StartsWith("Twelve: 12 performers "));
  folder_.write("s/show.yaml", folder_.read("s/show.yaml") + "\nabsent: [3, 5]\n");
  EXPECT_THAT(footlight({"plan", show_, "--pictures", folder_ / "pictures"}).out, StartsWith("Twelve: 10 performers "));
  EXPECT_EQ(footlight({"check", show_}).status, 0);
}

TEST_F(StarterShow, HarmedStagesAreNotUsed) {
  ASSERT_EQ(footlight({"plan", show_}).status, 0);
  const std::string before = folder_.read("s/show.plan");
  std::string stages = folder_.read("s/show.stages");
  stages[stages.size() / 2] ^= 1;
  folder_.write("s/show.stages", stages);
  const Ran ran = footlight({"plan", show_});
  EXPECT_EQ(ran.status, 0);
  EXPECT_THAT(ran.err, HasSubstr("planning everything anew: '" + folder_ / "s/show.stages" + "': it is harmed\n"));
  EXPECT_EQ(folder_.read("s/show.plan"), before);
}

TEST_F(StarterShow, ThePlanIsTheSameForAnyNumberOfThreads) {
  EXPECT_EQ(footlight({"plan", show_, "-o", folder_ / "1.plan", "--threads", "1"}).status, 0);
  EXPECT_EQ(footlight({"plan", show_, "-o", folder_ / "3.plan", "--threads", "3"}).status, 0);
  EXPECT_EQ(folder_.read("1.plan"), folder_.read("3.plan"));
}

TEST_F(StarterShow, JsonIsAlone) {
  const Ran plan = footlight({"plan", show_, "--json"});
  const json summary = json::parse(plan.out);
  EXPECT_EQ(summary["valid"], true);
  EXPECT_EQ(summary["performers"], 12);
  EXPECT_EQ(summary["sections"].size(), 3U);
  EXPECT_GE(summary["min_clearance_m"], 0.5);
  EXPECT_LE(summary["max_speed_m_s"], 1.4);
  const json measured = json::parse(footlight({"measure", show_, "--json"}).out);
  EXPECT_EQ(measured["valid"], true);
  EXPECT_EQ(measured["too_close"], 0);
  EXPECT_EQ(measured["sections"][1]["name"], "ring");
  EXPECT_EQ(measured["min_clearance_m"], summary["min_clearance_m"]);
}

TEST_F(StarterShow, ProgressIsToldInLinesWhenAskedFor) {
  const Ran ran = footlight({"plan", show_, "--progress"});
  EXPECT_THAT(ran.err, HasSubstr("100%\n"));
  EXPECT_THAT(ran.err, ::testing::Not(HasSubstr("\r")));
}

TEST_F(StarterShow, APlanIsUsedAgainWhileTheShowIsTheSame) {
  ASSERT_EQ(footlight({"plan", show_, "-q"}).status, 0);
  EXPECT_EQ(footlight({"measure", show_}).err, "");
  replace("count: 12", "count: 12 ");
  EXPECT_EQ(footlight({"measure", show_}).err,
            "note: planning again, since the show has changed since '" + plan_ + "'\n");
  const Ran given = footlight({"measure", show_, "--plan", plan_});
  EXPECT_EQ(given.status, 2);
  EXPECT_EQ(given.err,
            "error: '" + plan_ + "' was planned from another show, or before the show was changed (plan it again)\n");
  std::filesystem::remove(plan_);
  EXPECT_EQ(footlight({"measure", show_}).err,
            "note: planning, since '" + plan_ + "' is not there (footlight plan writes it)\n");
  EXPECT_EQ(footlight({"measure", show_, "-q"}).err, "");
}

TEST_F(StarterShow, AHarmedPlanIsMadeAnewUnlessItWasAskedFor) {
  ASSERT_EQ(footlight({"plan", show_}).status, 0);
  folder_.write("s/show.plan", folder_.read("s/show.plan").substr(0, 5000));
  const Ran again = footlight({"measure", show_});
  EXPECT_EQ(again.status, 0);
  EXPECT_THAT(again.err, StartsWith("note: planning again: cannot use '" + plan_ + "': "));
  const Ran given = footlight({"measure", show_, "--plan", plan_});
  EXPECT_EQ(given.status, 2);
  EXPECT_THAT(given.err, StartsWith("error: cannot use '" + plan_ + "': "));
}

/// A file with a right digest, as somebody with a tool of their own could write it.
TEST_F(StarterShow, APlanThatBreaksItsLimitsNeverReachesAMarker) {
  ASSERT_EQ(footlight({"plan", show_}).status, 0);
  auto plan = config::load_plan(plan_);
  ASSERT_TRUE(plan) << plan.error().message;
  plan->tracks[1] = plan->tracks[0];
  ASSERT_TRUE(plan->valid);
  ASSERT_TRUE(config::save_plan(*plan, plan_));
  const Ran given = footlight({"dryrun", show_, "--plan", plan_, "--trace", folder_ / "trace"});
  EXPECT_EQ(given.status, 3);
  EXPECT_EQ(given.out, "");
  const std::string broken =
      "the plan in '" + plan_ +
      "' breaks its limits: performers 1 and 2 stand on one cell, A2, at 0.000 s (plan it again)\n";
  EXPECT_EQ(given.err, "error: " + broken);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "trace"));
  const Ran again = footlight({"dryrun", show_});
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(again.err, "note: planning again: " + broken);
}

TEST_F(StarterShow, APlanThatBreaksItsLimitsIsMeasuredAndMarked) {
  ASSERT_EQ(footlight({"plan", show_}).status, 0);
  auto plan = config::load_plan(plan_);
  ASSERT_TRUE(plan) << plan.error().message;
  plan->tracks[1] = plan->tracks[0];
  const std::string broken = folder_ / "broken.plan";
  ASSERT_TRUE(config::save_plan(*plan, broken));
  const json alone = json::parse(footlight({"measure", broken, "--json"}).out);
  EXPECT_EQ(alone["valid"], false);
  EXPECT_EQ(alone["min_clearance_m"], 0.0);
  EXPECT_EQ(alone["closest"]["performers"], json({"1", "2"}));
  EXPECT_GT(alone["too_close"], 0);
  json with_show = json::parse(footlight({"measure", show_, "--plan", broken, "--json"}).out);
  EXPECT_EQ(with_show["file"], show_);
  with_show["file"] = broken;
  EXPECT_EQ(with_show, alone);
  const Ran both = footlight({"measure", show_, broken});
  EXPECT_EQ(both.status, 0);
  EXPECT_THAT(both.out, HasSubstr("\n" + broken + " (not valid)  "));
  EXPECT_THAT(both.out, ::testing::Not(HasSubstr(show_ + " (not valid)")));
}

TEST_F(StarterShow, PlanningTimeIsToldWhereThereWasPlanning) {
  EXPECT_GT(json::parse(footlight({"measure", show_, "--json"}).out)["planning_s"], 0.0);
  ASSERT_EQ(footlight({"plan", show_}).status, 0);
  EXPECT_EQ(json::parse(footlight({"measure", show_, "--json"}).out)["planning_s"], json());
}

TEST_F(StarterShow, OnePlanForSeveralShowsIsRefused) {
  const Ran ran = footlight({"measure", show_, show_, "--plan", plan_});
  EXPECT_EQ(ran.status, 2);
  EXPECT_EQ(ran.err, "error: --plan goes with one show (name plan files beside the shows instead)\n");
}

TEST_F(StarterShow, APlanOfAFilmIsMeasuredAlikeWithoutItsShowAndSaysWhenTheFilmIsGone) {
  std::filesystem::copy_file(kVideo, folder_ / "s/film.avi");
  folder_.write("s/show.yaml",
                "footlight: 1\ntitle: Film\nstage: {grid: {kind: square, columns: 12, rows: 8, pitch: 1 m}}\n"
                "performers: {count: 12}\nmusic: {tempo: 100}\nsections:\n"
                "  - {name: ring, from: {video: film.avi}, start: count 1, duration: 16 counts}\n");
  ASSERT_EQ(footlight({"plan", show_}).status, 0);
  const json with_show = json::parse(footlight({"measure", show_, "--json"}).out);
  const json alone = json::parse(footlight({"measure", plan_, "--json"}).out);
  EXPECT_GT(alone["frames"], 0);
  for (const char* figure : {"theta_dev", "theta_dev_var", "theta_miss", "theta_iou"}) {
    EXPECT_EQ(alone[figure], with_show[figure]) << figure;
  }
  std::filesystem::remove(folder_ / "s/film.avi");
  const Ran gone = footlight({"measure", plan_, "--json"});
  EXPECT_EQ(gone.status, 0);
  EXPECT_THAT(gone.err, StartsWith("note: the drawing of section ring is not measured: "));
  EXPECT_EQ(json::parse(gone.out)["theta_dev"], json());
}

TEST_F(StarterShow, DarkNodesAreJudgedOneByOne) {
  const Ran ran = footlight({"dark", show_, "--json", "-q"});
  EXPECT_EQ(ran.status, 0);
  const json told = json::parse(ran.out);
  EXPECT_EQ(told["nodes"], 3);
  EXPECT_EQ(told["supplies"], 0);
  ASSERT_EQ(told["units"].size(), 3U);
  for (const json& unit : told["units"]) EXPECT_LE(unit["unsafe"], unit["not_shown"]);
  EXPECT_THAT(footlight({"dark", show_, "-q"}).out, HasSubstr("of 3 nodes have cues that become unsafe when dark\n"));
}

TEST_F(StarterShow, ARefusedPlanHasNoDarkNodes) {
  make_unwalkable();
  EXPECT_EQ(footlight({"dark", show_, "-q"}).status, 3);
}

TEST_F(StarterShow, ExportsThreeFiles) {
  const Ran ran = footlight({"export", show_, "--csv", folder_ / "csv/deep", "-q"});
  EXPECT_EQ(ran.status, 0);
  EXPECT_EQ(ran.err, "");
  EXPECT_EQ(ran.out, folder_ / "csv/deep/marks.csv\n" + folder_ / "csv/deep/formations.csv\n" +
                         folder_ / "csv/deep/stage.json\n");
  EXPECT_EQ(json::parse(folder_.read("csv/deep/stage.json"))["valid"], true);
  const std::string marks = folder_.read("csv/deep/marks.csv");
  EXPECT_THAT(marks, StartsWith("performer,count,time_s,col,row,x_m,y_m,look,section\n1,1,0,"));
  EXPECT_THAT(marks, HasSubstr("\n12,57,33.6,"));
}

TEST_F(StarterShow, DrawsAPictureOfEveryKeyFormation) {
  const Ran ran = footlight({"plan", show_, "--pictures", folder_ / "pictures"});
  EXPECT_EQ(ran.status, 0) << ran.err;
  for (const char* name : {"001-line-1.png", "002-ring-1.png", "003-arrow-1.png"}) {
    EXPECT_THAT(folder_.read(std::string("pictures/") + name), StartsWith("\x89PNG")) << name;
  }
}

TEST_F(StarterShow, ThePicturesOfAnEarlierPlanDoNotStayBesideThoseOfThisOne) {
  const std::string pictures = folder_ / "pictures";
  ASSERT_EQ(footlight({"plan", show_, "--pictures", pictures}).status, 0);
  folder_.write("pictures/004-mine-1.png", "not drawn by us");
  replace("  - {name: arrow, from: {cells: arrow.csv}, start: count 49, hold: 8 counts}\n", "");
  replace("  - {number: \"3\", section: arrow, name: Arrow}\n", "");
  ASSERT_EQ(footlight({"plan", show_, "--pictures", pictures}).status, 0);
  Names names;
  for (const auto& entry : std::filesystem::directory_iterator(pictures)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (Names{"001-line-1.png", "002-ring-1.png", "004-mine-1.png", "pictures.txt"}));
  EXPECT_EQ(folder_.read("pictures/pictures.txt"), "001-line-1.png\n002-ring-1.png\n");
}

TEST_F(StarterShow, AChangedRigLeavesThePlanAsItIs) {
  folder_.write("s/rig.yaml", "rig: 1\nbuses: [{name: a, url: \"sim://rtu\"}]\nfloor: {buses: a}\n");
  replace("# rig: rig.yaml", "rig: rig.yaml");
  ASSERT_EQ(footlight({"plan", show_}).status, 0);
  folder_.write("s/rig.yaml",
                "rig: 1\nbuses: [{name: a, url: \"sim://rtu\", bits_per_second: 57600}]\nfloor: {buses: a}\n");
  const Ran ran = footlight({"dryrun", show_});
  EXPECT_EQ(ran.status, 0);
  EXPECT_EQ(ran.err, "");
  const Ran over = footlight({"plan", show_, "-o", folder_ / "s/rig.yaml"});
  EXPECT_EQ(over.status, 2) << "it is read all the same";
}

TEST_F(StarterShow, ASeedBelowZeroIsRefused) {
  const Ran ran = footlight({"dryrun", show_, "--seed", "-1"});
  EXPECT_EQ(ran.status, 2);
  EXPECT_EQ(ran.err, "error: --seed: a seed is a whole number from 0 on (footlight --help tells what there is)\n");
}

TEST_F(StarterShow, DeadNodesLeaveSomebodyToLookAt) {
  const Ran ran = footlight({"dryrun", show_, "-q", "--faults", "dead=500"});
  EXPECT_EQ(ran.status, 2);
  EXPECT_EQ(ran.err, "error: faults: \"dead=500\" leaves none of the rig's 3 nodes (at most dead=2)\n");
  EXPECT_EQ(ran.out, "");
}

TEST_F(StarterShow, ABusWithoutNodesCarriesNothing) {
  folder_.write("s/rig.yaml",
                "rig: 1\nbuses:\n  - {name: a, url: \"sim://rtu\"}\n  - {name: b, url: \"sim://can\"}\n"
                "  - {name: c, url: \"sim://serial\"}\nfloor: {buses: a}\n");
  replace("# rig: rig.yaml", "rig: rig.yaml");
  const json report = json::parse(footlight({"dryrun", show_, "-q", "--json"}).out);
  for (const int bus : {1, 2}) {
    EXPECT_EQ(report["buses"][bus]["nodes"], 0);
    EXPECT_EQ(report["buses"][bus]["frames"], 0);
    EXPECT_EQ(report["buses"][bus]["utilisation"], 0);
  }
}

TEST_F(StarterShow, APictureInWhichNothingIsSeenIsWarnedOf) {
  std::filesystem::copy_file(kVideo, folder_ / "s/film.avi");
  replace("{cells: ring.csv}, start: count 25, hold: 8 counts",
          "{video: film.avi, threshold: 255}, start: count 25, duration: 8 counts");
  EXPECT_THAT(footlight({"check", show_}).err,
              StartsWith(show_ + ":26:5: warning: sections[1].from: nothing in it is brighter than 255: the picture of "
                                 "every frame is empty and everybody waits in the reserve (a lower threshold, or "
                                 "threshold: otsu)\n"));
}

/// The first line must be there while the show still plays.
TEST_F(StarterShow, RealTimeLinesComeAsTheyHappen) {
  ASSERT_EQ(footlight({"plan", show_}).status, 0);
  const std::string out = folder_ / "out";
  const Ran ran = footlight({"dryrun", show_, "--realtime"}, out, [&](pid_t pid) {
    for (int i = 0; i < 3000 && (!std::filesystem::exists(out) || std::filesystem::file_size(out) == 0); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    EXPECT_THAT(folder_.read("out"), HasSubstr("opening"));
    kill(pid, SIGINT);
  });
  EXPECT_EQ(ran.status, 130);
}

TEST_F(StarterShow, WhatCannotBeWalkedIsRefusedAndWritesNothing) {
  make_unwalkable();
  const Ran plan = footlight({"plan", show_});
  EXPECT_EQ(plan.status, 3);
  EXPECT_THAT(plan.err, StartsWith(show_ + ":26:5: error: sections[1]: performer "));
  EXPECT_THAT(plan.out, HasSubstr("\nring "));
  EXPECT_EQ(files(), as_made_);
  const Ran check = footlight({"check", show_});
  EXPECT_EQ(check.status, 3);
  EXPECT_EQ(check.err, plan.err);
  const Ran exported = footlight({"export", show_, "--csv", folder_ / "csv", "-q"});
  EXPECT_EQ(exported.status, 3);
  EXPECT_EQ(exported.err, plan.err);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "csv"));
}

TEST_F(StarterShow, ARefusedPlanCanBeMeasuredAndExportedAndSaysSo) {
  make_unwalkable();
  const json measured = json::parse(footlight({"measure", show_, "--json"}).out);
  EXPECT_EQ(measured["valid"], false);
  EXPECT_GT(measured["max_speed_m_s"], 1.4);
  const Ran exported = footlight({"export", show_, "--csv", folder_ / "csv", "--unchecked"});
  EXPECT_EQ(exported.status, 0);
  EXPECT_THAT(exported.err, HasSubstr("note: the plan is refused; stage.json says \"valid\": false\n"));
  EXPECT_EQ(json::parse(folder_.read("csv/stage.json"))["valid"], false);
}

TEST_F(StarterShow, ARefusedShowLeavesAnOlderPlanAlone) {
  ASSERT_EQ(footlight({"plan", show_}).status, 0);
  const std::string before = folder_.read("s/show.plan");
  make_unwalkable();
  EXPECT_EQ(footlight({"plan", show_}).status, 3);
  EXPECT_EQ(folder_.read("s/show.plan"), before);
}

TEST_F(StarterShow, AFullDiskIsReportedAndLeavesNothing) {
  const Ran ran = test::run_program({"sh", "-c", "ulimit -f 4; exec \"$0\" \"$@\"", FOOTLIGHT_PROGRAM, "plan", show_});
  EXPECT_EQ(ran.status, 2);
  EXPECT_EQ(ran.err, "error: cannot write '" + plan_ + "': File too large\n");
  EXPECT_EQ(files(), as_made_);
}

TEST_F(StarterShow, AResultThatNobodyCanReadIsNoSuccess) {
  const Ran ran = footlight({"plan", show_, "-q"}, "/dev/full");
  EXPECT_EQ(ran.status, 2);
  EXPECT_EQ(ran.err, "error: cannot write the result to stdout: No space left on device\n");
}

TEST_F(StarterShow, AnOutputNeverOverwritesWhatTheShowReads) {
  const std::string before = folder_.read("s/show.yaml");
  const Ran ran = footlight({"plan", show_, "-q", "-o", show_});
  EXPECT_EQ(ran.status, 2);
  EXPECT_EQ(ran.err, "error: '" + show_ + "' is a file that the show reads (give the output another name)\n");
  const Ran traced = footlight({"dryrun", show_, "-q", "--trace", show_});
  EXPECT_EQ(traced.status, 2);
  EXPECT_EQ(traced.err, ran.err);
  EXPECT_EQ(folder_.read("s/show.yaml"), before);
}

TEST_F(StarterShow, ANewShowWithoutANameIsRefused) {
  const Ran ran = footlight({"new", ""});
  EXPECT_EQ(ran.status, 2);
  EXPECT_EQ(ran.err, "error: the new show's folder needs a name (footlight new my-show)\n");
}

TEST_F(StarterShow, AFolderThatCannotBeWrittenIsNamed) {
  const Ran ran = footlight({"plan", show_, "-o", folder_ / "no/such/x.plan"});
  EXPECT_EQ(ran.status, 2);
  EXPECT_EQ(ran.err, "error: cannot write '" + folder_ / "no/such/x.plan" + "': No such file or directory\n");
  const Ran csv = footlight({"export", show_, "-q", "--csv", show_});
  EXPECT_EQ(csv.status, 2);
  EXPECT_EQ(csv.err, "error: cannot make the folder '" + show_ + "': Not a directory\n");
}

TEST_F(StarterShow, AnInterruptionEndsLongWorkAndLeavesNothing) {
  std::filesystem::copy_file(kVideo, folder_ / "s/film.avi");
  replace("{cells: ring.csv}, start: count 25, hold: 8 counts",
          "{video: film.avi}, start: count 25, duration: 8 counts");
  as_made_ = files();
  // A decoder that says it has begun, and then never ends.
  const std::string decoder = folder_.write("decoder", "#!/bin/sh\n: >" + folder_ / "begun" + "\nexec sleep 1000\n");
  chmod(decoder.c_str(), 0700);
  setenv("FOOTLIGHT_DECODER", decoder.c_str(), 1);
  const Ran ran = footlight({"plan", show_}, "", [&](pid_t pid) {
    while (!std::filesystem::exists(folder_ / "begun")) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    kill(pid, SIGINT);
  });
  unsetenv("FOOTLIGHT_DECODER");
  EXPECT_EQ(ran.status, 130);
  EXPECT_EQ(ran.out, "");
  EXPECT_EQ(ran.err, "error: interrupted while decoding '" + folder_ / "s/film.avi" + "'\n");
  EXPECT_EQ(files(), as_made_);
}

}  // namespace
}  // namespace footlight
