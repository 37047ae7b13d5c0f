// SPDX-License-Identifier: Apache-2.0
#include "app/rehearsing/mute_orders.hpp"

#include <memory>
#include <optional>

#include <gtest/gtest.h>

#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

struct Ear final : Surface {
  void look(const DeskView& view, RunDesk& /*desk*/) override { seen = view; }
  void told(const RunEvent& event) override { heard.push_back((event.refused ? "refused: " : "") + event.text); }
  [[nodiscard]] bool listens() const override { return true; }
  DeskView seen;
  std::vector<std::string> heard;
};

class MuteOrdersTest : public ::testing::Test {
 protected:
  MuteOrdersTest()
      : small_(tests::random_show(6, 6, 4, 3, 2, 1)),
        schedule_({Look{}}, {controller::Switch{}}, 0, {}, 0, {}),
        desk_(small_.show, small_.plan),
        mutes_(small_.show) {
    schedule_.add_quiet(254);
    mutes_.add_to(desk_);
    desk_.add(ear_);
    view_.schedule = &schedule_;
    (void)desk_.look(view_);
  }
  std::optional<std::vector<bool>> say(const std::string& order) {
    desk_.say(order, {});
    return desk_.look(view_).muted;
  }
  tests::SmallShow small_;
  controller::CueSchedule schedule_;
  RunDesk desk_;
  MuteOrders mutes_;
  Ear ear_;
  DeskView view_;
};

using Muted = std::vector<bool>;

TEST_F(MuteOrdersTest, SoloMutesEverybodyElse) {
  EXPECT_EQ(say("solo Bloom"), (Muted{true, false, true}));
  EXPECT_EQ(ear_.heard.back(), "not guided: stem");
  EXPECT_EQ(ear_.seen.muted, "stem") << "the state tells it";
  EXPECT_EQ(say("solo stem, bloom"), (Muted{false, false, true}));
  EXPECT_EQ(say("solo off"), (Muted{false, false, false}));
  EXPECT_EQ(ear_.heard.back(), "everybody is guided");
}

TEST_F(MuteOrdersTest, MutesAndUnmutesGroupsAndThoseInNone) {
  small_.show.performers[3].group.reset();
  EXPECT_EQ(say("mute stem"), (Muted{true, false, false}));
  EXPECT_EQ(say("mute no group"), (Muted{true, false, true}));
  EXPECT_EQ(ear_.heard.back(), "not guided: stem, those in no group");
  EXPECT_EQ(say("unmute stem"), (Muted{false, false, true}));
  EXPECT_EQ(say("unmute"), (Muted{false, false, false}));
}

TEST_F(MuteOrdersTest, SaysWhatWouldBeRight) {
  EXPECT_EQ(say("mute leaf"), std::nullopt);
  EXPECT_EQ(ear_.heard.back(), "refused: mute: no group \"leaf\" (there are stem, bloom; \"no group\")");
  EXPECT_EQ(say("solo"), std::nullopt);
  EXPECT_EQ(ear_.heard.back(), "refused: solo: a group is wanted, as in \"solo stem\"");
  controller::CueSchedule full({Look{}}, {controller::Switch{}}, 0, {}, 0, {});
  view_.schedule = &full;
  (void)desk_.look(view_);
  EXPECT_EQ(say("mute stem"), std::nullopt);
  EXPECT_EQ(ear_.heard.back(), "refused: mute: no marker has room for the look of people who are muted");
}

}  // namespace
}  // namespace footlight::app
