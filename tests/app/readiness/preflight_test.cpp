// SPDX-License-Identifier: Apache-2.0
#include "app/readiness/preflight.hpp"

#include <atomic>
#include <optional>
#include <string>
#include <thread>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "app/load.hpp"
#include "core/clock.hpp"
#include "sim/endpoints/served_rig.hpp"
#include "tests/support/small_show.hpp"
#include "tests/support/temporary_folder.hpp"

namespace footlight::app {
namespace {

using ::testing::HasSubstr;
using State = Readiness::State;

/// A show whose floor is served on pseudo-terminals, perhaps with two devices at one address.
class Preflight : public ::testing::Test {
 protected:
  Preflight() {
    folder_.write("show.yaml",
                  "footlight: 1\ntitle: A floor\nstage: {grid: {columns: 6, rows: 4, pitch: 1 m}}\n"
                  "performers: {count: 2}\nrig: rig.yaml\n"
                  "sections:\n  - {name: line, from: {cells: line.csv}, start: count 1, hold: 8 counts}\n");
    folder_.write("line.csv", "performer,cell\n1,A1\n2,B1\n");
    // Nobody answers for a lamp.
    const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
    EXPECT_GE(::dup2(nothing, STDIN_FILENO), 0);
    ::close(nothing);
  }
  ~Preflight() override {
    over_.store(true);
    if (server_.joinable()) server_.join();
  }
  /// @param twice whether the second device has the address of the first
  void serve(bool twice) {
    folder_.write("rig.yaml",
                  "rig: 1\nbuses: [{name: left, kind: serial, url: 'sim://serial'}]\n"
                  "floor: {buses: [left], channels_per_node: 8}\n");
    auto loaded = read_show(session_, folder_ / "show.yaml");
    ASSERT_TRUE(loaded) << loaded.error().message;
    rig_ = loaded->rig;
    show_ = loaded->show;
    ASSERT_EQ(rig_.nodes.size(), 3U);
    // A spare whose address nobody has set, beside the one that has it.
    Rig real = rig_;
    if (twice) real.nodes[1].address = real.nodes[0].address;
    sim::Serving serving;
    serving.folder = folder_.path();
    auto served = sim::ServedRig::open(real, serving, clock_, nullptr);
    ASSERT_TRUE(served) << served.error().message;
    served_ = std::move(served).value();
    rig_.buses[0].url = served_->served()[0].url;
    server_ = std::thread([this] {
      while (!over_.load()) served_->step(milliseconds(20), [](Instant) {});
    });
  }
  Readiness::Report roll_call(Readiness& readiness, const std::optional<std::string>& outlived = {}) {
    EarlyDesk desk(small_.show, small_.plan, rig_, readiness, clock_);
    const auto done = preflight(session_, {rig_, outlived}, show_, readiness, desk);
    EXPECT_TRUE(done) << done.error().message;
    return readiness.report()[static_cast<std::size_t>(Readiness::Stage::roll_call)];
  }

  test::TemporaryFolder folder_;
  std::atomic<bool> stop_{false};
  Session session_{stop_};
  SteadyClock clock_;
  Rig rig_;
  Show show_;
  tests::SmallShow small_ = tests::random_show(6, 4, 2, 1, 1, 1);  // what a desk speaks of
  std::unique_ptr<sim::ServedRig> served_;
  std::atomic<bool> over_{false};
  std::thread server_;
};

TEST_F(Preflight, TwoDevicesAtOneAddressLockGoInEveryScopeThatOpensPorts) {
  serve(true);
  for (const Scope scope : {Scope::rehearsal, Scope::lights_only, Scope::live}) {
    Readiness readiness(scope);
    const auto stage = roll_call(readiness);
    EXPECT_EQ(stage.state, State::error) << to_text(scope);
    EXPECT_THAT(stage.text, HasSubstr("two devices at one address, `footlight devices set-address` tells them apart: " +
                                      rig_.nodes[0].name + ": several devices at address 1 (unique ids "));
    EXPECT_TRUE(readiness.refuses_go()) << to_text(scope);
    const auto answered = readiness.override_stage("roll-call", "somebody");
    ASSERT_FALSE(answered);
    EXPECT_THAT(answered.error().message, HasSubstr("nobody answers for that"));
    readiness.tell(Readiness::Stage::roll_call, State::success, "3 nodes answer");
    EXPECT_TRUE(readiness.refuses_go()) << "for the whole run";
  }
}

TEST_F(Preflight, AFloorWithoutDoublesIsNotLocked) {
  serve(false);
  Readiness readiness(Scope::rehearsal);
  EXPECT_NE(roll_call(readiness).state, State::error);
  EXPECT_FALSE(readiness.refuses_go());
}

TEST_F(Preflight, ARunThatIsTakenUpAsksNobody) {
  serve(true);
  Readiness readiness(Scope::rehearsal);
  EXPECT_NE(roll_call(readiness, "").state, State::error) << "it has asked when it began, and lamps are waiting";
}

}  // namespace
}  // namespace footlight::app
