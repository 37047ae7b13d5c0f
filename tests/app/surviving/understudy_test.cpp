// SPDX-License-Identifier: Apache-2.0
#include "app/surviving/understudy.hpp"

#include <filesystem>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "app/surfaces/run_desk.hpp"
#include "app/surviving/lead_port.hpp"
#include "core/machine_time.hpp"
#include "core/rng.hpp"
#include "tests/support/small_show.hpp"
#include "tests/support/temporary_folder.hpp"

namespace footlight::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Place running() {
  Place place;
  place.where.position = instant_at(6);
  place.where.cue = 1;
  place.where.waits = false;
  place.where.runs_since = instant_at(98);
  place.where.percent = 80;
  place.where.hold_at = instant_at(8);
  place.where.step_to = instant_at(7);
  place.where.loop = {instant_at(1), instant_at(9)};
  place.at = seconds(100);
  place.time = {true, false};
  place.emergency_hold = true;
  place.readiness = R"({"scope":"live","armed":true})";
  return place;
}

// ---- lines

TEST(LeadLine, APlaceIsHeardAsItWasSaidByAnotherClock) {
  const auto heard = place_in(place_line(running(), seconds(100)), seconds(5000));
  ASSERT_TRUE(heard);
  EXPECT_EQ(heard->at, seconds(5000));
  EXPECT_EQ(heard->where.position, instant_at(6));
  EXPECT_EQ(heard->where.runs_since, instant_at(4998)) << "two seconds ago";
  EXPECT_EQ(heard->where.cue, 1U);
  EXPECT_FALSE(heard->where.waits);
  EXPECT_EQ(heard->where.percent, 80);
  EXPECT_EQ(heard->where.hold_at, instant_at(8));
  EXPECT_EQ(heard->where.step_to, instant_at(7));
  EXPECT_EQ(heard->where.loop->from, instant_at(1));
  EXPECT_EQ(heard->where.loop->to, instant_at(9));
  EXPECT_EQ(heard->time, running().time);
  EXPECT_TRUE(heard->emergency_hold);
  EXPECT_EQ(heard->readiness, running().readiness);
}

TEST(LeadLine, TheLongestWordOfReadinessFits) {
  Place place = running();
  place.readiness = std::string(8192 / 2, '"') + std::string(8192 / 2, 'x');
  ASSERT_LE(place_line(place, {}).size(), kLongestLeadLine);
  EXPECT_EQ(place_in(place_line(place, {}), {})->readiness, place.readiness);
}

TEST(LeadLine, WhatIsNoLineIsNoneAndNothingElseHappens) {
  EXPECT_TRUE(rc::check([] {
    Rng rng(*rc::gen::arbitrary<std::uint64_t>());
    std::string line = place_line(running(), seconds(100));
    for (std::uint64_t i = 0; i < 1 + rng.below(6); ++i) {
      const auto at = static_cast<std::size_t>(rng.below(line.size()));
      if (rng.below(3) == 0) {
        line.erase(at, 1 + static_cast<std::size_t>(rng.below(20)));
      } else {
        line[at] = static_cast<char>(rng.below(256));
      }
      if (line.empty()) line = "{";
    }
    if (const auto place = place_in(line, seconds(1))) {
      RC_ASSERT(place->where.percent >= 25);
      RC_ASSERT(place->where.percent <= 200);
    }
    (void)leads_in(line);
    (void)follow_request(line);
    (void)take_over_in(line);
  }));
  EXPECT_FALSE(place_in(
      R"({"place": {"position_ns": 1e300, "percent": 100, "waits": true, "over": false, "in_reset": false}})", {}));
  EXPECT_FALSE(place_in(
      R"({"place": {"position_ns": 18446744073709551615, "percent": 100, "waits": true, "over": false, "in_reset": false}})",
      {}));
  EXPECT_FALSE(leads_in(R"({"leads": 0})"));
  EXPECT_FALSE(leads_in(R"({"leads": 4294967296})"));
  EXPECT_FALSE(leads_in(std::string(100'000, '[')));
}

// ---- when to take over

TEST(FollowedLead, TakesOverAfterASecondOfSilence) {
  FollowedLead lead;
  EXPECT_FALSE(lead.is_lost(seconds(1000))) << "there was none yet";
  EXPECT_EQ(lead.hear(leads_line(7), seconds(1)), "");
  EXPECT_FALSE(lead.is_lost(seconds(1000))) << "it has not said where it is";
  EXPECT_EQ(lead.hear(place_line(running(), seconds(100)), seconds(2)), "");
  EXPECT_FALSE(lead.is_lost(seconds(2.999)));
  EXPECT_TRUE(lead.is_lost(seconds(3)));
  EXPECT_EQ(lead.epoch(), 7U);
}

TEST(FollowedLead, ALeadThatWasBegunAgainIsFollowedOn) {
  FollowedLead lead;
  (void)lead.hear(leads_line(7), seconds(1));
  (void)lead.hear(place_line(running(), seconds(100)), seconds(1));
  (void)lead.hear(leads_line(8), seconds(1.9));
  EXPECT_FALSE(lead.is_lost(seconds(2.5)));
  EXPECT_EQ(lead.epoch(), 8U) << "whoever takes over has to be newer than the newest";
}

TEST(FollowedLead, ARunThatEndsOfItsOwnWillIsNotTakenOver) {
  FollowedLead lead;
  EXPECT_EQ(lead.hear(over_line("quit"), seconds(1)), "the run that led has ended (quit)");
  EXPECT_EQ(lead.hear(refused_line("another plan is led here"), seconds(1)),
            "the lead refuses this understudy: another plan is led here");
}

// ---- the door

class LeadPortTest : public ::testing::Test {
 protected:
  LeadPortTest() : small_(tests::random_show(6, 6, 4, 3, 2, 1)), desk_(small_.show, small_.plan) { desk_.add(ears_); }
  void open(const std::string& token) {
    auto opened = LeadPort::open({"127.0.0.1", 0, token, "abc", 7});
    ASSERT_TRUE(opened) << opened.error().message;
    door_ = std::move(opened).value();
  }
  /// What a cue thread says that lives.
  void look() {
    DeskView view;
    view.show.at = Instant(machine_time());
    view.show.where.position = instant_at(4);
    door_->look(view, desk_);
    door_->beat(view.show);
  }
  FollowSettings settings(const std::string& plan = "abc", const std::string& token = "") {
    FollowSettings out;
    out.host = "127.0.0.1";
    out.port = door_->port();
    out.plan = plan;
    out.token = token;
    out.note = [this](const std::string& line) { notes_.push_back(line); };
    out.stop = &stop_;
    return out;
  }
  /// Follows beside a run that looks until `ends`.
  Result<TakenOver> follow_until(const FollowSettings& settings, const std::function<bool()>& ends) {
    std::optional<Result<TakenOver>> outcome;
    std::atomic<bool> over{false};
    std::thread understudy([&] {
      outcome = follow(settings);
      over.store(true);
    });
    while (!over.load() && !ends()) {
      look();
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    understudy.join();
    look();  // what was told last
    return std::move(*outcome);
  }

  struct Ears final : Surface {
    void look(const DeskView& /*view*/, RunDesk& /*desk*/) override {}
    void told(const RunEvent& event) override { heard.push_back(event.text); }
    [[nodiscard]] bool listens() const override { return true; }
    std::vector<std::string> heard;
  } ears_;
  tests::SmallShow small_;
  RunDesk desk_;
  std::unique_ptr<LeadPort> door_;
  std::vector<std::string> notes_;
  std::atomic<bool> stop_{false};
};

TEST_F(LeadPortTest, WhoeverFollowsTakesOverWhenTheCueThreadFallsSilent) {
  open("");
  int looks = 0;
  const auto taken = follow_until(settings(), [&] { return ++looks > 60 && !ears_.heard.empty(); });
  ASSERT_TRUE(taken) << taken.error().message;
  EXPECT_EQ(taken->place.where.position, instant_at(4));
  EXPECT_EQ(taken->epoch, 1007U);
  EXPECT_EQ(taken->because, "the run that led has been silent for 1.0 s");
  EXPECT_THAT(ears_.heard, ElementsAre("an understudy follows"));
}

TEST_F(LeadPortTest, AnOperatorsWishIsToldToTheLead) {
  open("");
  auto wish = settings();
  wish.wants_to_lead = [&] { return notes_.size() > 1; };
  const auto taken = follow_until(wish, [] { return false; });
  ASSERT_TRUE(taken) << taken.error().message;
  for (int i = 0; i < 500 && door_->taken_over() == 0; ++i) {
    look();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  EXPECT_EQ(door_->taken_over(), 1007U);
}

TEST_F(LeadPortTest, AnotherPlanAndAnotherTokenAreRefusedAndSeen) {
  open("");
  const auto plan = follow_until(settings("def"), [] { return false; });
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().message, "the lead refuses this understudy: another plan is led here");
  open(std::string(64, 'a'));
  const auto token = follow_until(settings("abc", std::string(64, 'b')), [] { return false; });
  ASSERT_FALSE(token);
  EXPECT_EQ(token.error().message, "the lead refuses this understudy: another token is wanted");
  EXPECT_THAT(ears_.heard, ElementsAre("an understudy with another plan was refused",
                                       "an understudy without the right token was refused"));
}

TEST_F(LeadPortTest, WhoFollowsWithThePlanBeforeIsSentAwayWhenAnotherIsTaken) {
  open("");
  bool taken = false;
  const auto before = follow_until(settings(), [&] {
    if (notes_.size() > 1 && !std::exchange(taken, true)) door_->plan_is("def");
    return false;
  });
  ASSERT_FALSE(before) << "it takes over nothing: places of the new plan mean something else in its own";
  EXPECT_EQ(before.error().message,
            "the lead refuses this understudy: another plan is led from now on: begin it again");
  look();
  EXPECT_THAT(ears_.heard, ElementsAre("an understudy follows",
                                       "the understudy has the plan before this one: begin it again with these files"));
  EXPECT_EQ(follow_until(settings("abc"), [] { return false; }).error().message,
            "the lead refuses this understudy: another plan is led here");
  auto wish = settings("def");
  notes_.clear();
  wish.wants_to_lead = [&] { return notes_.size() > 1; };
  const auto after = follow_until(wish, [] { return false; });
  ASSERT_TRUE(after) << after.error().message;
  const std::size_t heard = ears_.heard.size();
  door_->plan_is("def");
  look();
  EXPECT_EQ(ears_.heard.size(), heard) << "the same plan again is no other one";
}

TEST_F(LeadPortTest, GoodByeIsNoReasonToTakeOver) {
  open("");
  bool said = false;
  const auto taken = follow_until(settings(), [&] {
    if (notes_.size() > 1 && !said) {
      door_->close("quit");
      said = true;
    }
    return said;
  });
  ASSERT_FALSE(taken);
  EXPECT_EQ(taken.error().message, "the run that led has ended (quit)");
}

TEST_F(LeadPortTest, AnAddressThatOthersReachNeedsAToken) {
  const auto open = LeadPort::open({"0.0.0.0", 0, "", "abc", 7});
  ASSERT_FALSE(open);
  EXPECT_EQ(open.error().message, "--lead 0.0.0.0:0: an address that other machines reach needs --lead-token");
  EXPECT_EQ(LeadPort::open({"host", 0, "x", "abc", 7}).error().message,
            "--lead host:0: an IPv4 address is wanted, as in 127.0.0.1 or 192.168.1.7");
  EXPECT_TRUE(is_loopback("127.3.2.1"));
  EXPECT_FALSE(is_loopback("128.0.0.1"));
}

TEST(LeadToken, IsMadeOnceForItsOwnerAlone) {
  const test::TemporaryFolder folder;
  const auto token = token_in(folder / "token");
  ASSERT_TRUE(token) << token.error().message;
  EXPECT_EQ(token->size(), 64U);
  EXPECT_EQ(*token_in(folder / "token"), *token);
  const auto mode = std::filesystem::status(folder / "token").permissions();
  EXPECT_EQ(mode, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  std::filesystem::permissions(folder / "token", std::filesystem::perms::group_read,
                               std::filesystem::perm_options::add);
  EXPECT_EQ(token_in(folder / "token").error().message,
            "the token '" + (folder / "token") + "' may be read by others (chmod 600 " + (folder / "token") + ")");
}

}  // namespace
}  // namespace footlight::app
