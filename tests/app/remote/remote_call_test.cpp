// SPDX-License-Identifier: Apache-2.0
#include "app/remote/remote_call.hpp"

#include <gtest/gtest.h>

#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

using Kind = RemoteCall::Kind;
using Phase = controller::Rehearsal::Phase;

class RemoteCallTest : public ::testing::Test {
 protected:
  RemoteCallTest()
      : small_(tests::random_show(6, 6, 4, 3, 2, 1)), plays_(controller::cue_plays(small_.show, small_.plan)) {
    view_.show.standby = 1;
  }
  std::string words(Kind kind, const std::string& text = "") {
    auto out = words_of({kind, text}, view_, plays_);
    return out ? out.value() : "refused: " + out.error().message;
  }

  tests::SmallShow small_;
  std::vector<controller::CuePlay> plays_;
  DeskView view_;
};

TEST_F(RemoteCallTest, BecomesWordsOfTheDesk) {
  EXPECT_EQ(words(Kind::go), "go");
  EXPECT_EQ(words(Kind::hold), "hold");
  EXPECT_EQ(words(Kind::top), "top");
  EXPECT_EQ(words(Kind::load_cue, "3"), "jump cue 3");
  EXPECT_EQ(words(Kind::order, "  tempo 80 "), "tempo 80");
}

TEST_F(RemoteCallTest, StartsACueOnlyWhereItIsStandbyAndTheShowWaits) {
  EXPECT_EQ(words(Kind::start_cue, "2"), "go");
  EXPECT_EQ(words(Kind::start_cue, "3"), "refused: cue 3 is not standby (2 is): load it, then people have a way there");
  EXPECT_EQ(words(Kind::start_cue, "9"), "refused: no cue \"9\" (there are 1, 2, 3)");
  view_.show.active = 0;
  EXPECT_EQ(words(Kind::start_cue, "2"), "refused: cue 2 is standby, but the show does not wait for it");
  view_.show.active = -1;
  view_.show.reset.state = controller::Rehearsal::ResetState::ready;
  EXPECT_EQ(words(Kind::start_cue, "2"), "refused: cue 2 is standby, but the show does not wait for it");
}

TEST_F(RemoteCallTest, ResumeGoesOnAndNeverStartsACue) {
  EXPECT_EQ(words(Kind::resume), "refused: nothing is held");
  view_.show.active = 0;
  EXPECT_EQ(words(Kind::resume), "go");
  view_.show.phase = Phase::runs;
  EXPECT_EQ(words(Kind::resume), "refused: nothing is held");
  view_.show.phase = Phase::reset_held;
  EXPECT_EQ(words(Kind::resume), "go");
}

TEST_F(RemoteCallTest, NobodyEndsARunFromAfar) {
  EXPECT_EQ(words(Kind::order, " QUIT "), "refused: a run is ended at its desk");
}

}  // namespace
}  // namespace footlight::app
