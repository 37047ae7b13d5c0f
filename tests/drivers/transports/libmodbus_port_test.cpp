// SPDX-License-Identifier: Apache-2.0
// The port over libmodbus against real kernel objects: a pseudo-terminal pair, TCP on the loopback.
#include <atomic>
#include <memory>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <modbus/modbus.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include "core/file_descriptor.hpp"
#include "core/look.hpp"
#include "drivers/devices/modbus/marker_registers.hpp"
#include "drivers/transports/modbus_port.hpp"
#include "tests/drivers/transports/pseudo_terminal.hpp"
#include "tests/drivers/wire_golden.hpp"

namespace footlight::drivers {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Outcome = ModbusReply::Outcome;

constexpr int kBaud = 115'200;
const SerialSettings kSettings{.bits_per_second = kBaud, .characters = Characters::e1};
const ModbusRequest kRead{7, 0x03, 0x40, 2, {}};

/// The answer of unit 7 to kRead with the registers 0x0102, 0x0304; check sums by hand with golden.py's function.
const Bytes kReadAnswer{0x07, 0x03, 0x04, 0x01, 0x02, 0x03, 0x04, 0x3D, 0x3C};

struct FreeModbus {
  void operator()(modbus_t* context) const { modbus_free(context); }
};
using Context = std::unique_ptr<modbus_t, FreeModbus>;
struct FreeMapping {
  void operator()(modbus_mapping_t* mapping) const { modbus_mapping_free(mapping); }
};
using Mapping = std::unique_ptr<modbus_mapping_t, FreeMapping>;

class RtuPort : public ::testing::Test {
 protected:
  RtuPort() {
    auto opened = open_modbus_rtu(terminal_.path(), kSettings);
    EXPECT_TRUE(opened) << (opened ? "" : opened.error().message);
    port_ = std::move(opened).value();
  }
  /// Submits while another thread reads the request and gives these bytes as its answer.
  std::optional<ModbusReply> exchange(const ModbusRequest& request, const Bytes& answer) {
    std::thread device([&] {
      requested_ = terminal_.read(rtu_request_bytes(request));
      if (!answer.empty()) terminal_.write(answer);
    });
    EXPECT_EQ(port_->submit(request), SendStatus::accepted);
    device.join();
    return port_->poll();
  }

  PseudoTerminal terminal_;
  std::unique_ptr<ModbusPort> port_;
  Bytes requested_;
};

TEST_F(RtuPort, PutsTheDocumentedBytesOnTheLine) {
  const Golden golden("modbus.txt");
  const ModbusProfile marker = footlight_marker_profile();
  const Look grass{{0x7C, 0xFC, 0x00}, Effect::blink, 200};
  std::vector<LookIndex> looks;
  for (unsigned i = 0; i < 32; ++i) looks.push_back(static_cast<LookIndex>(7 * i));
  for (const auto& [name, request] : std::vector<std::pair<std::string, ModbusRequest>>{
           {"latch", modbus::latch(marker, 0, 0xA3, 17).front()},
           {"heartbeat", modbus::heartbeat(marker, 0, 0x12345678).front()},
           {"look", modbus::look_entry(marker, 0, 5, grass).front()}}) {
    ASSERT_EQ(port_->submit(request), SendStatus::accepted);
    EXPECT_FALSE(port_->busy()) << "a broadcast is over when it is sent";
    EXPECT_EQ(port_->poll(), std::nullopt);
    EXPECT_EQ(terminal_.read(rtu_request_bytes(request)), golden.bytes(name)) << name;
  }
  exchange(modbus::preload(marker, 7, 0xA3, 17, looks).front(), kReadAnswer);
  EXPECT_EQ(requested_, golden.bytes("preload-32"));
  exchange(modbus::status_request(marker, 7), kReadAnswer);
  EXPECT_EQ(requested_, golden.bytes("ask"));
}

TEST_F(RtuPort, GivesTheRegistersOfARightAnswer) {
  const auto reply = exchange(kRead, kReadAnswer);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->outcome, Outcome::ok);
  EXPECT_EQ(reply->unit, 7);
  EXPECT_EQ(reply->function, 3);
  EXPECT_EQ(reply->values, (std::vector<std::uint16_t>{0x0102, 0x0304}));
  EXPECT_EQ(port_->poll(), std::nullopt) << "once";
}

TEST_F(RtuPort, SilenceIsATimeOut) {
  const auto reply = exchange(kRead, {});
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->outcome, Outcome::timeout);
  EXPECT_TRUE(reply->values.empty());
}

TEST_F(RtuPort, ThrowsAwayWhatNobodyWaitsForWhenToldTo) {
  ASSERT_EQ(exchange(kRead, {})->outcome, Outcome::timeout);
  EXPECT_FALSE(port_->discard());
  const Bytes late{0x07, 0x03, 0x04, 0x0B, 0xAD, 0x0B, 0xAD, 0xC9, 0x7B};
  terminal_.write(late);
  EXPECT_TRUE(port_->discard());
  EXPECT_FALSE(port_->discard());
  const auto reply = exchange(kRead, kReadAnswer);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->outcome, Outcome::ok);
  EXPECT_EQ(reply->values, (std::vector<std::uint16_t>{0x0102, 0x0304}));
}

TEST_F(RtuPort, KnowsAnAnswerOfAnotherLengthForWrong) {
  const Bytes of_one{0x07, 0x03, 0x02, 0x01, 0x02, 0x31, 0x95};
  EXPECT_EQ(exchange(kRead, of_one)->outcome, Outcome::garbled);
}

TEST_F(RtuPort, AWrongCheckSumOrUnitIsGarbled) {
  Bytes bad = kReadAnswer;
  bad.back() ^= 1;
  EXPECT_EQ(exchange(kRead, bad)->outcome, Outcome::garbled);
  const Bytes of_eight{0x08, 0x03, 0x04, 0x01, 0x02, 0x03, 0x04, 0xC2, 0x3C};
  EXPECT_NE(exchange(kRead, of_eight)->outcome, Outcome::ok);
  EXPECT_EQ(exchange(kRead, kReadAnswer)->outcome, Outcome::ok) << "the line is clean again";
}

TEST_F(RtuPort, APulledCableIsDown) {
  terminal_.unplug();
  EXPECT_EQ(port_->submit(kRead), SendStatus::down);
  EXPECT_EQ(port_->submit({0, 0x10, 0, 1, {5}}), SendStatus::down);
}

TEST_F(RtuPort, SpeaksToAServerOfLibmodbus) {
  Context server(modbus_new_rtu("/dev/null", kBaud, 'E', 8, 1));
  modbus_set_slave(server.get(), 7);
  modbus_set_socket(server.get(), terminal_.near());
  const Mapping mapping(modbus_mapping_new(0, 0, 0x20, 0));
  std::thread device([&] {
    for (int requests = 0; requests < 4; ++requests) {
      Bytes request(MODBUS_RTU_MAX_ADU_LENGTH);
      const int length = modbus_receive(server.get(), request.data());
      if (length <= 0) return;
      modbus_reply(server.get(), request.data(), length, mapping.get());
    }
  });
  const auto ask = [&](const ModbusRequest& request) {
    EXPECT_EQ(port_->submit(request), SendStatus::accepted);
    return port_->poll().value_or(ModbusReply{Outcome::garbled, 0, 0, 0, {}});
  };
  EXPECT_EQ(ask({7, 0x10, 3, 2, {0xCAFE, 0xBABE}}).outcome, Outcome::ok);
  EXPECT_EQ(ask({7, 0x06, 5, 1, {0x1234}}).outcome, Outcome::ok);
  EXPECT_EQ(ask({7, 0x03, 3, 3, {}}).values, (std::vector<std::uint16_t>{0xCAFE, 0xBABE, 0x1234}));
  const ModbusReply refused = ask({7, 0x03, 0x1F, 2, {}});
  EXPECT_EQ(refused.outcome, Outcome::exception);
  EXPECT_EQ(refused.exception_code, 2);
  device.join();
}

TEST_F(RtuPort, TheLineIsOursAlone) {
  const FileDescriptor another(::open(terminal_.path().c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK));
  if (another.get() < 0) {
    EXPECT_EQ(errno, EBUSY);
    return;
  }
  int exclusive = 0;  // root gets everything, but is told
  ASSERT_EQ(::ioctl(another.get(), TIOCGEXCL, &exclusive), 0);
  EXPECT_EQ(exclusive, 1);
}

TEST(RtuLine, OneThatIsNotThereIsRefusedWithWhatWouldHelp) {
  const auto port = open_modbus_rtu("/dev/serial/by-id/none", kSettings);
  ASSERT_FALSE(port);
  EXPECT_EQ(port.error().message,
            "serial port \"/dev/serial/by-id/none\": No such file or directory (a port as listed in "
            "/dev/serial/by-id)");
}

/// A Modbus TCP server of libmodbus on a free port of the loopback; serves one connection after the other.
class TcpServer {
 public:
  TcpServer() : context_(modbus_new_tcp("127.0.0.1", 0)), mapping_(modbus_mapping_new(0, 0, 0x100, 0)) {
    listener_ = modbus_tcp_listen(context_.get(), 1);
    EXPECT_GE(listener_, 0);
    sockaddr_in address{};
    socklen_t length = sizeof address;
    EXPECT_EQ(::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &length), 0);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this, listener = listener_] { serve(listener); });
  }
  ~TcpServer() {
    ending_ = true;
    ::shutdown(listener_, SHUT_RDWR);
    hang_up();
    thread_.join();
    ::close(listener_);
  }
  TcpServer(const TcpServer&) = delete;
  TcpServer& operator=(const TcpServer&) = delete;

  [[nodiscard]] int port() const { return port_; }
  [[nodiscard]] int writes() const { return writes_; }
  void hang_up() {
    if (const int connection = connection_; connection >= 0) ::shutdown(connection, SHUT_RDWR);
  }

 private:
  void serve(int listener) {
    while (!ending_) {
      int accepted = listener;
      const int connection = modbus_tcp_accept(context_.get(), &accepted);
      if (connection < 0) return;
      connection_ = connection;
      if (ending_) ::shutdown(connection, SHUT_RDWR);
      Bytes request(MODBUS_TCP_MAX_ADU_LENGTH);
      for (int length = 0; (length = modbus_receive(context_.get(), request.data())) > 0;) {
        writes_ += request[7] == MODBUS_FC_WRITE_MULTIPLE_REGISTERS ? 1 : 0;
        modbus_reply(context_.get(), request.data(), length, mapping_.get());
      }
      connection_ = -1;
      modbus_close(context_.get());
    }
  }

  Context context_;
  Mapping mapping_;
  int listener_ = -1;
  int port_ = 0;
  std::atomic<int> connection_{-1};
  std::atomic<int> writes_{0};
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

TEST(TcpPort, WritesAndReadsOverTheLoopback) {
  TcpServer server;
  auto port = open_modbus_tcp("127.0.0.1", server.port(), {1, 2, 3});
  ASSERT_TRUE(port) << port.error().message;
  ASSERT_EQ((*port)->submit({2, 0x10, 0x10, 2, {7, 8}}), SendStatus::accepted);
  EXPECT_EQ((*port)->poll()->outcome, Outcome::ok);
  ASSERT_EQ((*port)->submit({2, 0x03, 0x10, 2, {}}), SendStatus::accepted);
  EXPECT_EQ((*port)->poll()->values, (std::vector<std::uint16_t>{7, 8}));
}

TEST(TcpPort, ABroadcastGoesToEachUnitAndItsAnswersAreNotTakenForOthers) {
  TcpServer server;
  auto port = open_modbus_tcp("127.0.0.1", server.port(), {1, 2, 3});
  ASSERT_TRUE(port);
  for (std::uint16_t value = 1; value <= 20; ++value) {
    ASSERT_EQ((*port)->submit({0, 0x10, 0x20, 1, {value}}), SendStatus::accepted);
    EXPECT_FALSE((*port)->busy());
    ASSERT_EQ((*port)->submit({1, 0x03, 0x20, 1, {}}), SendStatus::accepted);
    const auto reply = (*port)->poll();
    ASSERT_TRUE(reply);
    ASSERT_EQ(reply->outcome, Outcome::ok);
    ASSERT_EQ(reply->values, (std::vector<std::uint16_t>{value}));
  }
  EXPECT_EQ(server.writes(), 60);
}

TEST(TcpPort, AConnectionThatIsLostIsDownOnceAndMadeAnew) {
  TcpServer server;
  auto port = open_modbus_tcp("127.0.0.1", server.port(), {1});
  ASSERT_TRUE(port);
  ASSERT_EQ((*port)->submit({1, 0x03, 0, 1, {}}), SendStatus::accepted);
  (*port)->poll();
  server.hang_up();
  EXPECT_EQ((*port)->submit({1, 0x03, 0, 1, {}}), SendStatus::down);
  ASSERT_EQ((*port)->submit({1, 0x03, 0, 1, {}}), SendStatus::accepted);
  EXPECT_EQ((*port)->poll()->outcome, Outcome::ok);
}

TEST(TcpPort, ADeviceThatIsSwitchedOffIsDownAndSaysWhatWouldHelp) {
  int closed_port = 0;
  {
    const TcpServer server;
    closed_port = server.port();
  }
  const auto port = open_modbus_tcp("127.0.0.1", closed_port, {1});
  ASSERT_TRUE(port) << "it may be switched on later";
  EXPECT_EQ((*port)->submit({1, 0x03, 0, 1, {}}), SendStatus::down);
  EXPECT_EQ((*port)->trouble(), "Modbus device \"127.0.0.1:" + std::to_string(closed_port) +
                                    "\": not opened: Connection refused (a device that is switched on and reached by "
                                    "this network)");
}

/// Takes connections and never answers.
class DeafHost {
 public:
  DeafHost() : listener_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t length = sizeof address;
    EXPECT_EQ(::bind(listener_.get(), reinterpret_cast<sockaddr*>(&address), length), 0);
    EXPECT_EQ(::listen(listener_.get(), 64), 0);
    EXPECT_EQ(::getsockname(listener_.get(), reinterpret_cast<sockaddr*>(&address), &length), 0);
    port_ = ntohs(address.sin_port);
  }
  [[nodiscard]] int port() const { return port_; }
  /// True when somebody has tried to connect.
  [[nodiscard]] bool called() const {
    pollfd file{listener_.get(), POLLIN, 0};
    return ::poll(&file, 1, 0) > 0;
  }

 private:
  FileDescriptor listener_;
  int port_ = 0;
};

TEST(TcpPort, OpeningWaitsForNobody) {
  const DeafHost deaf;
  const auto port = open_modbus_tcp("127.0.0.1", deaf.port(), {1});
  ASSERT_TRUE(port);
  EXPECT_FALSE(deaf.called()) << "the bus's own thread connects";
  EXPECT_EQ((*port)->submit({1, 0x03, 0, 1, {}}), SendStatus::accepted);
  EXPECT_TRUE(deaf.called());
  EXPECT_EQ((*port)->poll()->outcome, Outcome::timeout);
}

TEST(TcpPort, ADeadHostDelaysNoOther) {
  // In order of events: an exchange with the living begins and ends while one and the same request to the dead waits.
  const DeafHost deaf;
  const TcpServer server;
  auto dead = open_modbus_tcp("127.0.0.1", deaf.port(), {1});
  auto living = open_modbus_tcp("127.0.0.1", server.port(), {1});
  std::atomic<int> begun{0};
  std::atomic<int> ended{0};
  std::atomic<bool> enough{false};
  std::thread other_bus([&] {
    while (!enough) {
      ++begun;
      (*dead)->submit({1, 0x03, 0, 1, {}});
      (*dead)->poll();
      ++ended;
    }
  });
  bool meanwhile = false;
  for (int tries = 0; tries < 100 && !meanwhile; ++tries) {
    const int before = ended;
    while (begun == before) std::this_thread::yield();
    EXPECT_EQ((*living)->submit({1, 0x03, 0, 1, {}}), SendStatus::accepted);
    EXPECT_EQ((*living)->poll()->outcome, Outcome::ok);
    meanwhile = ended == before;
  }
  enough = true;
  other_bus.join();
  EXPECT_TRUE(meanwhile);
}

}  // namespace
}  // namespace footlight::drivers
