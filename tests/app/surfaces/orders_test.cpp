// SPDX-License-Identifier: Apache-2.0
#include "app/surfaces/orders.hpp"

#include <gtest/gtest.h>

#include "app/surfaces/show_timecode.hpp"
#include "tests/support/small_show.hpp"

namespace footlight::app {
namespace {

using Kind = controller::Command::Kind;
using tests::cue_of;

/// Sections s1 [0, 4], s2 [8, 12], s3 [16, 20] s; 120 counts a minute.
class OrdersTest : public ::testing::Test {
 protected:
  OrdersTest() : small_(tests::random_show(6, 6, 4, 3, 2, 1)) {
    small_.show.cues = {cue_of("1", 0), cue_of("2", 1), cue_of("2.5", 2)};
    small_.plan.sections[1].name = "Big Ring";
  }
  [[nodiscard]] controller::Command command(std::string_view line) const {
    const auto order = Orders(small_.show, small_.plan).from(line);
    EXPECT_TRUE(order) << line << ": " << (order ? "" : order.error().message);
    return order ? order->command : controller::Command{};
  }
  [[nodiscard]] std::string error(std::string_view line) const {
    const auto order = Orders(small_.show, small_.plan).from(line);
    EXPECT_FALSE(order) << line;
    return order ? "" : order.error().message;
  }
  tests::SmallShow small_;
};

TEST_F(OrdersTest, PlainWordsAreOrders) {
  EXPECT_EQ(command("").kind, Kind::go);
  EXPECT_EQ(command("  GO ").kind, Kind::go);
  EXPECT_EQ(command("hold").kind, Kind::hold);
  EXPECT_EQ(command("hold  freeze").kind, Kind::hold);
  EXPECT_EQ(command("hold end").kind, Kind::hold_at_end);
  EXPECT_EQ(command("run on").kind, Kind::run_on);
  EXPECT_EQ(command("loop off").kind, Kind::loop_off);
  EXPECT_EQ(command("tempo 80").percent, 80);
  EXPECT_EQ(command("tempo 80%").percent, 80);
  EXPECT_EQ(command("tempo 80 %").percent, 80);
}

TEST_F(OrdersTest, PlacesAreFoundByCueSectionCountAndTime) {
  EXPECT_EQ(command("jump cue 2").position, instant_at(4)) << "the walk into a section belongs to its cue";
  EXPECT_EQ(command("jump cue 2.50").position, instant_at(12));
  EXPECT_EQ(command("jump section big ring").position, instant_at(8));
  EXPECT_EQ(command("jump count 17").position, instant_at(8));
  EXPECT_EQ(command("jump time 0:09.5").position, instant_at(9.5));
  EXPECT_EQ(command("top").position, instant_at(0));
  const controller::Command loop = command("loop section big ring");
  EXPECT_EQ(loop.position, instant_at(8));
  EXPECT_EQ(loop.until, instant_at(12));
  EXPECT_EQ(command("loop counts 5 9").until, instant_at(4));
}

TEST_F(OrdersTest, ATimecodeIsAPlaceByTheRatesAndTheStartOfTheShow) {
  const auto at_the_end_of = [](Duration frame_begins, FrameRate rate) {
    return Instant(frame_begins + frame_time(rate) - Duration(1));
  };
  EXPECT_EQ(command("jump time 00:00:01:05").position, at_the_end_of(milliseconds(1200), FrameRate::fps25));
  EXPECT_EQ(command("jump time 00:00:01;05").position, command("jump time 00:00:01:05").position);
  EXPECT_EQ(command("jump time 00:00:20:00").position, instant_at(20)) << "the end of the show";
  small_.show.time.start = time_of({23, 59, 59, 0, FrameRate::fps25});
  EXPECT_EQ(command("jump time 00:00:01:05").position, at_the_end_of(milliseconds(2200), FrameRate::fps25))
      << "the tape has passed midnight";
  small_.show.time.rate = FrameRate::fps2997_drop;
  small_.show.time.start = time_of({1, 0, 59, 28, FrameRate::fps2997_drop});
  const Instant fourth = at_the_end_of(2 * frame_time(FrameRate::fps2997_drop), FrameRate::fps2997_drop);
  EXPECT_NEAR(to_seconds(command("jump time 01:01:00;02").position), to_seconds(fourth), 1e-8)
      << "frames 0 and 1 of this minute are not there";
}

TEST_F(OrdersTest, TheTimecodeThatIsShownAtAPlaceLeadsToThatPlace) {
  for (int rate = 0; rate < kFrameRates; ++rate) {
    small_.show.time.rate = static_cast<FrameRate>(rate);
    small_.show.time.start = time_of({1, 0, 0, 0, small_.show.time.rate});
    for (const double place_s : {0.0, 2.0, 8.0, 12.0, 20.0}) {
      const std::string shown =
          timecode_text(instant_at(place_s).time_since_epoch() + small_.show.time.start, small_.show.time.rate);
      const Instant position = command("jump time " + shown).position;
      EXPECT_GE(position, instant_at(place_s)) << shown;
      EXPECT_LE(position - instant_at(place_s), frame_time(small_.show.time.rate)) << shown;
    }
  }
}

TEST_F(OrdersTest, ATimecodeThatIsNoneOfTheShowSaysWhichAre) {
  small_.show.time.start = time_of({1, 0, 0, 0, FrameRate::fps25});
  const std::string right =
      "jump: a timecode from 01:00:00:00 to 01:00:20:00 (25 frames a second) is wanted, or a time as in \"jump time "
      "1:23.5\"";
  for (const char* code : {"01:00:20:01", "00:59:59:24", "01:00:01:25", "1:0:1:5", "01:00:01:5x", "01:00:60:00"}) {
    EXPECT_EQ(error(std::string("jump time ") + code), right);
  }
  small_.show.time.rate = FrameRate::fps2997_drop;
  small_.show.time.start = time_of({1, 0, 50, 0, FrameRate::fps2997_drop});
  EXPECT_EQ(error("jump time 01:01:00;00"),
            "jump: a timecode from 01:00:50;00 to 01:01:10;01 (29.97 drop-frame frames a second) is wanted, or a time "
            "as in \"jump time 1:23.5\"");
}

TEST_F(OrdersTest, AWrongOrderSaysWhatWouldBeRight) {
  EXPECT_EQ(error("jmup cue 2"), "\"jmup cue 2\" is no order (\"help\" lists them)");
  EXPECT_EQ(error("jump"), "jump: cue, section, count or time is wanted, as in \"jump cue 12\"");
  EXPECT_EQ(error("jump cue 3"), "jump: no cue \"3\" (there are 1, 2, 2.5)");
  EXPECT_EQ(error("jump cue "), "jump: no cue \"\" (there are 1, 2, 2.5)");
  EXPECT_EQ(error("jump section ring"), "jump: no section \"ring\" (there are s1, Big Ring, s3)");
  EXPECT_EQ(error("jump count 99"), "jump: a count from 1 to 41 is wanted");
  EXPECT_EQ(error("jump count nan"), "jump: a count from 1 to 41 is wanted");
  EXPECT_EQ(error("jump count 1e300"), "jump: a count from 1 to 41 is wanted");
  EXPECT_EQ(error("jump time 1:99"), "jump: a time from 0.000 to 20.000 s is wanted, as in \"jump time 1:23.5\"");
  EXPECT_EQ(error("jump time 1:2:3:4"),
            "jump: a timecode from 00:00:00:00 to 00:00:20:00 (25 frames a second) is wanted, or a time as in \"jump "
            "time 1:23.5\"");
  EXPECT_EQ(error("loop"), "loop: cue, section, counts or off is wanted, as in \"loop counts 17 33\"");
  EXPECT_EQ(error("loop counts 9 5"),
            "loop: two ascending counts from 1 to 41 are wanted, as in \"loop counts 17 33\"");
  EXPECT_EQ(error("tempo 201"), "tempo: a percentage from 25 to 200 is wanted, as in \"tempo 80\"");
  EXPECT_EQ(error("tempo"), "tempo: a percentage from 25 to 200 is wanted, as in \"tempo 80\"");
}

}  // namespace
}  // namespace footlight::app
