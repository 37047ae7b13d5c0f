// SPDX-License-Identifier: Apache-2.0
#include "app/surviving/supervisor.hpp"

#include <csignal>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/support/temporary_folder.hpp"

namespace footlight::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class SupervisorTest : public ::testing::Test {
 protected:
  /// Every beginning of the script leaves its arguments in "begun". @param script of sh, whose $1 is "--resume" again
  int supervise(const std::string& script, Duration silence = seconds(30)) {
    const std::string file = folder_.write("child", "echo \"run $*\" >> " + (folder_ / "begun") + "\n" + script);
    return app::supervise("/bin/sh", {"sh", file}, silence, [&](const std::string& line) { notes_.push_back(line); });
  }
  [[nodiscard]] std::string begun() const { return folder_.read("begun"); }

  test::TemporaryFolder folder_;
  std::vector<std::string> notes_;
};

TEST_F(SupervisorTest, WhatEndsByItsOwnWillIsNotBegunAgain) {
  for (const int status : {0, 2, 3, 4, 130}) {
    EXPECT_EQ(supervise("exit " + std::to_string(status)), status);
  }
  EXPECT_EQ(begun(), "run \nrun \nrun \nrun \nrun \n");
  EXPECT_THAT(notes_, IsEmpty());
}

TEST_F(SupervisorTest, WhatIsKilledIsBegunAgainAndTakesItsPlaceUp) {
  EXPECT_EQ(supervise("test \"$1\" = --resume || kill -9 $$"), 0);
  EXPECT_EQ(begun(), "run \nrun --resume\n");
  EXPECT_THAT(notes_, ElementsAre("the run has died (Killed): it is begun again"));
}

TEST_F(SupervisorTest, ItIsAskedToResumeOnceHoweverOftenItDies) {
  EXPECT_EQ(supervise("echo >> " + (folder_ / "count") + "; test $(wc -l < " + (folder_ / "count") + ") = 4 || exit 1"),
            0);
  EXPECT_EQ(begun(), "run \nrun --resume\nrun --resume\nrun --resume\n");
  EXPECT_THAT(notes_[0], "the run has died (exit status 1): it is begun again");
}

TEST_F(SupervisorTest, OneWhoseWatchdogFallsSilentIsKilledAndBegunAgain) {
  // It speaks once, by python's socket, and hangs.
  const std::string speak =
      "test \"$1\" = --resume && exit 0\n"
      "/usr/bin/python3 -c \"import os, socket; a = os.environ['NOTIFY_SOCKET']; assert a[0] == '@'; "
      "s = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM); s.sendto(b'WATCHDOG=1', b'\\\\0' + a[1:].encode())\"\n"
      "exec sleep 600";
  EXPECT_EQ(supervise(speak, milliseconds(300)), 0);
  EXPECT_THAT(notes_, ElementsAre("the cue thread has been silent for 0.3 s: the run is killed",
                                  "the run has died (Killed): it is begun again"));
}

TEST_F(SupervisorTest, OneThatHasNeverSpokenIsLeftAlone) {
  EXPECT_EQ(supervise("sleep 0.5", milliseconds(100)), 0);
  EXPECT_THAT(notes_, IsEmpty());
}

TEST_F(SupervisorTest, ASignalThatIsSentToItEndsBoth) {
  std::thread sender([&] {
    sigset_t all;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_BLOCK, &all, nullptr);  // or it would take the signal, and that would be the end
    while (begun().empty()) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    ::kill(::getpid(), SIGTERM);
  });
  EXPECT_EQ(supervise("trap 'exit 130' TERM; while :; do sleep 0.05; done"), 130);
  sender.join();
  EXPECT_EQ(begun(), "run \n");
}

TEST(Supervisor, RestsWhenAChildKeepsDyingYoung) {
  EXPECT_EQ(rest_before(0), Duration{});
  EXPECT_EQ(rest_before(1), Duration{}) << "once is bad luck";
  EXPECT_EQ(rest_before(2), milliseconds(50));
  EXPECT_EQ(rest_before(3), milliseconds(100));
  EXPECT_EQ(rest_before(50), milliseconds(2000));
}

TEST(Supervisor, BeginsAgainWhatFindsItsPortsBusyAfterADeath) {
  EXPECT_FALSE(begins_again({false, 4}, false, false)) << "they are not there";
  EXPECT_TRUE(begins_again({false, 4}, false, true)) << "whoever had them has just died";
  EXPECT_FALSE(begins_again({false, 4}, true, true)) << "the show is over, and a lamp was not right";
  EXPECT_TRUE(begins_again({true, SIGSEGV}, true, false));
}

}  // namespace
}  // namespace footlight::app
