// SPDX-License-Identifier: Apache-2.0
#include "sim/endpoints/served_rig.hpp"

#include <array>

#include <arpa/inet.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/can.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "serial_frame.hpp"
#include "sim/endpoints/can_endpoint.hpp"
#include "sim/markers/check_sums.hpp"
#include "small_rig.hpp"
#include "tests/support/temporary_folder.hpp"

namespace footlight::sim {
namespace {

using Bytes = std::vector<std::uint8_t>;
using ::testing::ElementsAre;

/// A served rig in a time that moves by 100 us a step.
class ServedRigTest : public ::testing::Test {
 protected:
  void serve(const Rig& rig, const Faults& faults = {}) {
    Serving serving;
    serving.folder = folder_.path();
    serving.faults = faults;
    serving.show_length = std::chrono::seconds(10);
    auto served = ServedRig::open(rig, serving, clock_, nullptr);
    ASSERT_TRUE(served) << served.error().message;
    served_ = std::move(served).value();
  }
  void run_for(Duration duration) {
    const Instant end = clock_.now() + duration;
    while (clock_.now() < end) {
      clock_.advance(microseconds(100));
      served_->step(Duration{}, [&](Instant now) {
        EXPECT_GE(now, seen_);
        seen_ = now;
      });
    }
  }
  [[nodiscard]] FileDescriptor open_terminal() const {
    return FileDescriptor(::open((folder_ / "b").c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  }
  [[nodiscard]] FileDescriptor connect() const {
    const std::string url = served_->served().at(0).url;
    FileDescriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    struct sockaddr_in address {};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1))));
    EXPECT_EQ(::connect(socket.get(), reinterpret_cast<struct sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(::fcntl(socket.get(), F_SETFL, O_NONBLOCK), 0);
    return socket;
  }
  /// What comes back within 50 ms of the wire's time.
  Bytes ask(const FileDescriptor& file, const Bytes& request) {
    EXPECT_EQ(::write(file.get(), request.data(), request.size()), static_cast<ssize_t>(request.size()));
    run_for(milliseconds(50));
    return answer(file);
  }
  static Bytes answer(const FileDescriptor& file) {
    Bytes buffer(512);
    const ssize_t count = ::read(file.get(), buffer.data(), buffer.size());
    buffer.resize(count < 0 ? 0 : static_cast<std::size_t>(count));
    return buffer;
  }
  [[nodiscard]] std::vector<int> shown(std::uint32_t node) const {
    std::vector<int> looks;
    for (int i = 0; i < 4; ++i) looks.push_back(served_->rig().shown(NodeIndex(node), i));
    return looks;
  }

  test::TemporaryFolder folder_;
  ManualClock clock_;
  Instant seen_ = kStart;
  std::unique_ptr<ServedRig> served_;
};

Bytes rtu(Bytes bytes) {
  const std::uint16_t check = crc16_modbus(bytes);
  bytes.push_back(static_cast<std::uint8_t>(check & 0xFFU));
  bytes.push_back(static_cast<std::uint8_t>(check >> 8U));
  return bytes;
}

const Bytes kRtuPreload = rtu({2, 0x10, 0, 0, 0, 3, 6, 0xA3, 5, 7, 8, 9, 10});
const Bytes kRtuLatch = rtu({0, 0x10, 0, 0x20, 0, 3, 6, 0xA3, 5, 0xA3 ^ 0x5A, 5 ^ 0x5A, 0xA3 ^ 0xA5, 5 ^ 0xA5});

TEST_F(ServedRigTest, AnRtuMasterPreloadsLatchesAndReadsBack) {
  serve(small_rig(BusKind::modbus_rtu, 2, 4, 115'200));
  EXPECT_EQ(served_->served().at(0).url, "rtu://" + (folder_ / "b"));
  const FileDescriptor line = open_terminal();
  EXPECT_EQ(ask(line, kRtuPreload), rtu({2, 0x10, 0, 0, 0, 3}));
  EXPECT_THAT(shown(1), ElementsAre(255, 255, 255, 255));
  EXPECT_EQ(ask(line, kRtuLatch), Bytes{}) << "nobody answers a broadcast";
  EXPECT_THAT(shown(1), ElementsAre(7, 8, 9, 10));
  EXPECT_EQ(ask(line, rtu({2, 3, 0, 0x40, 0, 1})), rtu({2, 3, 2, 5, 0}));
}

TEST_F(ServedRigTest, TheWireTakesItsTimeAndFramesWaitForEachOther) {
  serve(small_rig(BusKind::modbus_rtu, 2, 4, 19'200));
  const FileDescriptor line = open_terminal();
  ASSERT_EQ(::write(line.get(), kRtuPreload.data(), kRtuPreload.size()), static_cast<ssize_t>(kRtuPreload.size()));
  run_for(milliseconds(8));  // 15 characters of 11 bits at 19,200 Bd take 8.6 ms, and there is a silence after them
  EXPECT_EQ(answer(line), Bytes{});
  run_for(milliseconds(20));
  EXPECT_EQ(answer(line), rtu({2, 0x10, 0, 0, 0, 3}));
  Bytes two = rtu({0, 0x10, 0, 0x30, 0, 2, 4, 0, 0, 0, 1});  // a heartbeat: 7.4 ms and the silence
  two.insert(two.end(), kRtuLatch.begin(), kRtuLatch.end());
  ASSERT_EQ(::write(line.get(), two.data(), two.size()), static_cast<ssize_t>(two.size()));
  run_for(milliseconds(15));
  EXPECT_THAT(shown(1), ElementsAre(255, 255, 255, 255));
  run_for(milliseconds(10));
  EXPECT_THAT(shown(1), ElementsAre(7, 8, 9, 10));
}

TEST_F(ServedRigTest, NoiseOnTheLineIsCountedAndTheNextRequestIsAnswered) {
  serve(small_rig(BusKind::modbus_rtu, 1, 4, 115'200));
  const FileDescriptor line = open_terminal();
  EXPECT_EQ(ask(line, {1, 3, 0, 0x40, 0, 6, 0, 0}), Bytes{});
  const Bytes status = ask(line, rtu({1, 3, 0, 0x45, 0, 1}));
  EXPECT_EQ(status, rtu({1, 3, 2, 0, 1})) << "one frame dropped";
}

TEST_F(ServedRigTest, ASerialNodeAnswersWithItsStatus) {
  serve(small_rig(BusKind::serial, 2, 4, 115'200));
  EXPECT_EQ(served_->served().at(0).url, "serial://" + (folder_ / "b"));
  const FileDescriptor line = open_terminal();
  const Bytes said = ask(line, serial_frame({0x01, 0x04, 2, 0, 0}));
  ASSERT_GT(said.size(), 8U);
  EXPECT_EQ(said.front(), 0);
  EXPECT_EQ(said.back(), 0);
}

TEST_F(ServedRigTest, EachTcpClientGetsItsOwnAnswer) {
  serve(small_rig(BusKind::modbus_tcp, 2, 4, 0));
  const FileDescriptor first = connect();
  const FileDescriptor second = connect();
  run_for(milliseconds(1));
  const Bytes same_transaction{0, 9, 0, 0, 0, 6};
  Bytes to_one = same_transaction;
  to_one.insert(to_one.end(), {1, 3, 0, 0x42, 0, 1});
  Bytes to_two = same_transaction;
  to_two.insert(to_two.end(), {2, 3, 0, 0x43, 0, 1});
  ASSERT_EQ(::write(first.get(), to_one.data(), 7), 7) << "in two pieces";
  run_for(milliseconds(1));
  ASSERT_EQ(::write(first.get(), to_one.data() + 7, 5), 5);
  EXPECT_EQ(ask(second, to_two), (Bytes{0, 9, 0, 0, 0, 5, 2, 3, 2, 0, 1}));
  EXPECT_EQ(answer(first), (Bytes{0, 9, 0, 0, 0, 5, 1, 3, 2, 0, 0}));
}

TEST_F(ServedRigTest, ATcpClientThatSpeaksSomethingElseIsCutOffAlone) {
  serve(small_rig(BusKind::modbus_tcp, 1, 4, 0));
  const FileDescriptor stranger = connect();
  const FileDescriptor client = connect();
  EXPECT_EQ(ask(stranger, {'G', 'E', 'T', ' ', '/', '\r', '\n'}), Bytes{});
  char byte = 0;
  EXPECT_EQ(::read(stranger.get(), &byte, 1), 0) << "closed";
  EXPECT_EQ(ask(client, {0, 1, 0, 0, 0, 6, 1, 3, 0, 0x42, 0, 1}).size(), 11U);
}

TEST_F(ServedRigTest, ADeadNodeNeverAnswers) {
  Faults faults;
  faults.dead = 1;
  serve(small_rig(BusKind::modbus_rtu, 1, 4, 115'200), faults);
  const FileDescriptor line = open_terminal();
  EXPECT_EQ(ask(line, rtu({1, 3, 0, 0x40, 0, 1})), Bytes{});
  EXPECT_THAT(shown(0), ElementsAre(0, 0, 0, 0));
}

TEST_F(ServedRigTest, RestartsAreDrawnFromTheFirstByteOn) {
  Faults faults;
  faults.reboot = 1;
  serve(small_rig(BusKind::modbus_rtu, 1, 4, 115'200), faults);
  run_for(milliseconds(100));
  EXPECT_TRUE(served_->rig().reboots().empty());
  const FileDescriptor line = open_terminal();
  ask(line, rtu({1, 3, 0, 0x40, 0, 1}));
  ASSERT_EQ(served_->rig().reboots().size(), 1U);
  EXPECT_GE(served_->rig().reboots()[0].at, kStart + milliseconds(100));
}

TEST_F(ServedRigTest, ACanBusWithoutAnInterfaceIsLeftOutAndOneThatDoesNotExistIsAnError) {
  const Rig rig = small_rig(BusKind::can, 1, 4, 500'000);
  serve(rig);
  EXPECT_THAT(served_->left_out(), ElementsAre("b"));
  Serving serving;
  serving.folder = folder_.path();
  serving.can["b"] = "nowhere0";
  const auto refused = ServedRig::open(rig, serving, clock_, nullptr);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::device);
  EXPECT_THAT(refused.error().message, ::testing::StartsWith("bus \"b\": CAN interface \"nowhere0\": no"));
}

TEST_F(ServedRigTest, APortThatIsTakenIsNamed) {
  serve(small_rig(BusKind::modbus_tcp, 1, 4, 0));
  const std::string url = served_->served().at(0).url;
  Serving serving;
  serving.folder = folder_.path();
  serving.first_port = std::stoi(url.substr(url.rfind(':') + 1));
  const auto refused = ServedRig::open(small_rig(BusKind::modbus_tcp, 1, 4, 0), serving, clock_, nullptr);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message,
            "bus \"b\": port 127.0.0.1:" + std::to_string(serving.first_port) +
                ": not opened: Address already in use (--ports-from gives the first of the ports)");
}

/// A socket pair that keeps frame boundaries as a CAN socket does.
TEST(CanEndpoint, FramesGoToTheMarkersAndTheirAnswersComeBack) {
  Bench bench(small_rig(BusKind::can, 1, 4, 500'000));
  std::array<int, 2> pair{-1, -1};
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0, pair.data()), 0);
  const FileDescriptor program(pair[1]);
  CanEndpoint endpoint{FileDescriptor(pair[0]), "vcan0", bench.simulated.can(BusIndex(0))};
  EXPECT_EQ(endpoint.url(), "can://vcan0");
  struct can_frame raw {};
  raw.can_id = 0x000;
  raw.can_dlc = 2;
  raw.data[0] = 1;  // NMT start, all nodes
  ASSERT_EQ(::write(program.get(), &raw, sizeof raw), static_cast<ssize_t>(sizeof raw));
  raw = {};
  raw.can_id = 0x080;
  raw.can_dlc = 1;
  raw.data[0] = 9;  // SYNC 9
  ASSERT_EQ(::write(program.get(), &raw, sizeof raw), static_cast<ssize_t>(sizeof raw));
  std::vector<canid_t> heard;
  for (int ms = 0; ms < 30; ++ms) {
    endpoint.step(bench.clock.now());
    bench.run_for(milliseconds(1));
    while (::read(program.get(), &raw, sizeof raw) == static_cast<ssize_t>(sizeof raw)) heard.push_back(raw.can_id);
  }
  EXPECT_TRUE(endpoint.used());
  EXPECT_THAT(heard, ::testing::Contains(0x181)) << "the status that answers the SYNC";
}

}  // namespace
}  // namespace footlight::sim
