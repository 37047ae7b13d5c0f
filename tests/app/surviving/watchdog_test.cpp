// SPDX-License-Identifier: Apache-2.0
#include "app/surviving/watchdog.hpp"

#include <array>
#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>

#include "tests/support/temporary_folder.hpp"

namespace footlight::app {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// A service manager's end of the socket.
class WatchdogTest : public ::testing::Test {
 protected:
  WatchdogTest() {
    const std::string path = folder_ / "notify";
    sockaddr_un us{};
    us.sun_family = AF_UNIX;
    path.copy(us.sun_path, sizeof us.sun_path - 1);
    EXPECT_EQ(::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&us), sizeof us), 0);
    ::setenv("NOTIFY_SOCKET", path.c_str(), 1);
    ::setenv("WATCHDOG_USEC", "2000000", 1);
  }
  ~WatchdogTest() override {
    ::unsetenv("NOTIFY_SOCKET");
    ::unsetenv("WATCHDOG_USEC");
  }
  std::vector<std::string> heard() const {
    std::vector<std::string> all;
    std::array<char, 100> buffer{};
    for (ssize_t size = 0; (size = ::recv(socket_.get(), buffer.data(), buffer.size(), MSG_DONTWAIT)) > 0;) {
      all.emplace_back(buffer.data(), static_cast<std::size_t>(size));
    }
    return all;
  }
  static void look(Watchdog& watchdog, double at_s, bool roll_called) {
    ShowState state;
    state.at = instant_at(at_s);
    watchdog.beat(state, roll_called);
  }

  test::TemporaryFolder folder_;
  FileDescriptor socket_{::socket(AF_UNIX, SOCK_DGRAM, 0)};
};

TEST_F(WatchdogTest, IsReadyOnceWhenTheRollCallIsOver) {
  ::unsetenv("WATCHDOG_USEC");
  Watchdog watchdog;
  look(watchdog, 0, false);
  EXPECT_THAT(heard(), IsEmpty());
  look(watchdog, 1, true);
  look(watchdog, 2, true);
  EXPECT_THAT(heard(), ElementsAre("READY=1"));
}

TEST_F(WatchdogTest, IsFedOnlyWhileTheCueThreadSaysSomethingNew) {
  Watchdog watchdog;
  for (int i = 0; i <= 100; ++i) look(watchdog, 0.02 * i, false);
  EXPECT_EQ(heard().size(), 5U) << "every half second in two seconds";
  for (int i = 0; i < 100; ++i) look(watchdog, 2, false);
  EXPECT_THAT(heard(), IsEmpty()) << "a calling thread that lives is no sign of life";
}

TEST_F(WatchdogTest, ARunThatEndsByItselfSaysSo) {
  const Watchdog watchdog;
  watchdog.end();
  EXPECT_THAT(heard(), ElementsAre("STOPPING=1"));
}

TEST_F(WatchdogTest, WithoutAManagerNothingHappens) {
  for (const char* address : {"", "relative", "/no/such/socket"}) {
    ::setenv("NOTIFY_SOCKET", address, 1);
    Watchdog watchdog;
    look(watchdog, 0, true);
  }
  ::setenv("NOTIFY_SOCKET", std::string(500, '/').c_str(), 1);
  EXPECT_FALSE(Notifier().wanted());
}

}  // namespace
}  // namespace footlight::app
