// SPDX-License-Identifier: Apache-2.0
#include "app/wire_log/logged_ports.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "sim/modbus_frames.hpp"

namespace footlight::app {
namespace {

using drivers::ByteStream;
using drivers::CanFrame;
using drivers::CanPort;
using drivers::ModbusPort;
using drivers::ModbusReply;
using drivers::ModbusRequest;
using drivers::SendStatus;
using Bytes = std::vector<std::uint8_t>;
using Carried = std::atomic<Duration::rep>;

void add(Carried& carried, Duration time) { carried.fetch_add(time.count(), std::memory_order_relaxed); }

void append(Bytes& bytes, std::uint32_t value, int size) {
  for (int i = size - 1; i >= 0; --i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

/// LINKTYPE_RTAC_SERIAL: seconds and microseconds (unused), event, control lines, footer, then the bytes.
class LoggedStream final : public ByteStream {
 public:
  LoggedStream(WireLog& log, std::size_t bus, ByteStream& port, Carried& carried)
      : log_(log), bus_(bus), port_(port), carried_(carried) {
    packet_.reserve(kHeader + 4096);
  }
  SendStatus write(std::span<const std::uint8_t> bytes) override {
    const SendStatus status = port_.write(bytes);
    if (status == SendStatus::accepted && !bytes.empty()) record(Heading::sent, bytes);
    return status;
  }
  std::size_t read(std::span<std::uint8_t> buffer) override {
    const std::size_t count = port_.read(buffer);
    if (count > 0) record(Heading::received, buffer.first(count));
    return count;
  }
  [[nodiscard]] Duration wire_time(std::size_t bytes) const override { return port_.wire_time(bytes); }
  [[nodiscard]] int poll_handle() const override { return port_.poll_handle(); }
  [[nodiscard]] std::string trouble() const override { return port_.trouble(); }

 private:
  static constexpr std::size_t kHeader = 12;
  static constexpr std::uint8_t kTransmit = 1;
  static constexpr std::uint8_t kReceive = 2;

  void record(Heading heading, std::span<const std::uint8_t> bytes) {
    packet_.assign(kHeader, 0);
    packet_[8] = heading == Heading::sent ? kTransmit : kReceive;
    packet_.insert(packet_.end(), bytes.begin(), bytes.end());
    add(carried_, port_.wire_time(bytes.size()));
    log_.record(bus_, heading, packet_);
  }

  WireLog& log_;
  std::size_t bus_;
  ByteStream& port_;
  Carried& carried_;
  Bytes packet_;
};

/// LINKTYPE_CAN_SOCKETCAN: identifier with its flags, big-endian, length, FD flags, two bytes unused, data.
class LoggedCan final : public CanPort {
 public:
  LoggedCan(WireLog& log, std::size_t bus, CanPort& port, Carried& carried)
      : log_(log), bus_(bus), port_(port), carried_(carried) {}
  SendStatus send(const CanFrame& frame) override {
    const SendStatus status = port_.send(frame);
    if (status == SendStatus::accepted) record(Heading::sent, frame);
    return status;
  }
  bool receive(CanFrame& frame) override {
    if (!port_.receive(frame)) return false;
    record(Heading::received, frame);
    return true;
  }
  [[nodiscard]] Duration wire_time(const CanFrame& frame) const override { return port_.wire_time(frame); }
  [[nodiscard]] std::size_t queued() const override { return port_.queued(); }
  [[nodiscard]] drivers::CanState state() const override { return port_.state(); }
  [[nodiscard]] int poll_handle() const override { return port_.poll_handle(); }
  [[nodiscard]] std::string trouble() const override { return port_.trouble(); }

 private:
  static constexpr std::uint32_t kErrorFlag = 0x20000000;
  static constexpr std::uint8_t kFastFlag = 0x01;
  static constexpr std::uint8_t kFdFlag = 0x04;

  void record(Heading heading, const CanFrame& frame) {
    std::array<std::uint8_t, 8 + 64> packet{};
    const bool error = frame.kind == CanFrame::Kind::error;
    if (!error) add(carried_, port_.wire_time(frame));
    const std::uint32_t id = frame.id | (error ? kErrorFlag : 0);
    for (std::size_t i = 0; i < 4; ++i) packet[i] = static_cast<std::uint8_t>(id >> (24 - 8 * i));
    const std::size_t length = error ? 8 : frame.length;
    packet[4] = static_cast<std::uint8_t>(length);
    if (frame.kind == CanFrame::Kind::fd) packet[5] = kFdFlag;
    if (frame.kind == CanFrame::Kind::fd_fast) packet[5] = kFdFlag | kFastFlag;
    std::copy_n(frame.data.begin(), length, packet.begin() + 8);
    log_.record(bus_, heading, std::span(packet).first(8 + length));
  }

  WireLog& log_;
  std::size_t bus_;
  CanPort& port_;
  Carried& carried_;
};

/// Function code and data of the reply that has become this one; nothing where none has come.
std::optional<Bytes> reply_pdu(const ModbusRequest& request, const ModbusReply& reply) {
  if (reply.outcome == ModbusReply::Outcome::exception) {
    return Bytes{static_cast<std::uint8_t>(reply.function | 0x80U), reply.exception_code};
  }
  if (reply.outcome != ModbusReply::Outcome::ok) return std::nullopt;
  Bytes pdu = sim::request_pdu(request);
  if (reply.values.empty() && pdu.size() >= 5) {
    pdu.resize(5);  // a write is answered by its first five bytes
    return pdu;
  }
  pdu.resize(1);
  if (request.function == 0x01) {
    Bytes coils((reply.values.size() + 7) / 8, 0);
    for (std::size_t i = 0; i < reply.values.size(); ++i) {
      if (reply.values[i] != 0) coils[i / 8] = static_cast<std::uint8_t>(coils[i / 8] | (1U << (i % 8)));
    }
    append(pdu, static_cast<std::uint32_t>(coils.size()), 1);
    pdu.insert(pdu.end(), coils.begin(), coils.end());
  } else {
    append(pdu, static_cast<std::uint32_t>(2 * reply.values.size()), 1);
    for (const std::uint16_t value : reply.values) append(pdu, value, 2);
  }
  return pdu;
}

/// LINKTYPE_WIRESHARK_UPPER_PDU: tag 12, the name of the dissector, then the end of tags, then the frame of the line.
Bytes rtu_packet(std::uint8_t unit, const Bytes& pdu) {
  Bytes packet{0, 12, 0, 8, 'm', 'b', 'r', 't', 'u', 0, 0, 0, 0, 0, 0, 0};
  const Bytes frame = sim::rtu_frame(unit, pdu);
  packet.insert(packet.end(), frame.begin(), frame.end());
  return packet;
}

std::uint16_t internet_sum(std::span<const std::uint8_t> bytes, std::uint32_t sum = 0) {
  for (std::size_t i = 0; i < bytes.size(); ++i) sum += i % 2 == 0 ? std::uint32_t{bytes[i]} << 8U : bytes[i];
  while (sum > 0xFFFF) sum = (sum & 0xFFFF) + (sum >> 16U);
  return static_cast<std::uint16_t>(~sum);
}

/// One connection as somebody on the way would see it: LINKTYPE_IPV4. The library does not say which addresses its
/// connection has; those here are of TEST-NET-1 (RFC 5737), the last number of the device's being that of the bus.
class Connection {
 public:
  explicit Connection(std::size_t bus) : device_(static_cast<std::uint8_t>(2 + bus % 250)) {}

  Bytes packet(Heading heading, const Bytes& payload) {
    const bool out = heading == Heading::sent;
    Bytes ip{0x45, 0};
    append(ip, static_cast<std::uint32_t>(kIp + kTcp + payload.size()), 2);
    append(ip, ++identification_, 2);
    append(ip, 0x4000'4006, 4);  // not to be fragmented, 64 hops, TCP
    append(ip, 0, 2);
    for (const std::uint8_t last : {out ? kController : device_, out ? device_ : kController}) {
      append(ip, 0xC00002, 3);
      append(ip, last, 1);
    }
    put(ip, 10, internet_sum(ip));
    Bytes tcp;
    append(tcp, out ? kOurPort : kModbusPort, 2);
    append(tcp, out ? kModbusPort : kOurPort, 2);
    append(tcp, out ? sent_ : received_, 4);
    append(tcp, out ? received_ : sent_, 4);
    append(tcp, 0x5018'FFFF, 4);  // 20 bytes of header, PSH and ACK, window
    append(tcp, 0, 4);
    tcp.insert(tcp.end(), payload.begin(), payload.end());
    std::uint32_t pseudo = 6 + static_cast<std::uint32_t>(tcp.size());
    for (std::size_t i = 12; i < kIp; i += 2) pseudo += (std::uint32_t{ip[i]} << 8U) | ip[i + 1];
    put(tcp, 16, internet_sum(tcp, pseudo));
    (out ? sent_ : received_) += static_cast<std::uint32_t>(payload.size());
    ip.insert(ip.end(), tcp.begin(), tcp.end());
    return ip;
  }

 private:
  static constexpr std::size_t kIp = 20;
  static constexpr std::size_t kTcp = 20;
  static constexpr std::uint8_t kController = 1;
  static constexpr std::uint32_t kOurPort = 49'152;
  static constexpr std::uint32_t kModbusPort = 502;

  static void put(Bytes& bytes, std::size_t at, std::uint16_t value) {
    bytes[at] = static_cast<std::uint8_t>(value >> 8U);
    bytes[at + 1] = static_cast<std::uint8_t>(value & 0xFFU);
  }

  std::uint8_t device_;
  std::uint32_t sent_ = 1;
  std::uint32_t received_ = 1;
  std::uint16_t identification_ = 0;
};

class LoggedModbus final : public ModbusPort {
 public:
  LoggedModbus(WireLog& log, std::size_t bus, bool tcp, ModbusPort& port, Carried& carried)
      : log_(log), bus_(bus), tcp_(tcp), port_(port), carried_(carried), connection_(bus) {}

  SendStatus submit(const ModbusRequest& request) override {
    if (port_.busy()) return port_.submit(request);
    // Told before it is sent: a port of a blocking library has the reply when it comes back.
    record(Heading::sent, request.unit, sim::request_pdu(request), ++transaction_);
    request_ = request;
    const SendStatus status = port_.submit(request);
    if (status == SendStatus::accepted) add(carried_, port_.wire_time(request));
    return status;
  }
  std::optional<ModbusReply> poll() override {
    auto reply = port_.poll();
    if (!reply) return reply;
    if (const auto pdu = reply_pdu(request_, *reply)) record(Heading::received, reply->unit, *pdu, transaction_);
    return reply;
  }
  [[nodiscard]] bool busy() const override { return port_.busy(); }
  [[nodiscard]] Duration wire_time(const ModbusRequest& request) const override { return port_.wire_time(request); }
  bool discard() override { return port_.discard(); }
  [[nodiscard]] int poll_handle() const override { return port_.poll_handle(); }
  [[nodiscard]] std::string trouble() const override { return port_.trouble(); }

 private:
  void record(Heading heading, std::uint8_t unit, const Bytes& pdu, std::uint16_t transaction) {
    log_.record(bus_, heading,
                tcp_ ? connection_.packet(heading, sim::tcp_frame(transaction, unit, pdu)) : rtu_packet(unit, pdu));
  }

  WireLog& log_;
  std::size_t bus_;
  bool tcp_;
  ModbusPort& port_;
  Carried& carried_;
  Connection connection_;
  ModbusRequest request_;
  std::uint16_t transaction_ = 0;
};

}  // namespace

drivers::PortReference LoggedPorts::before(std::size_t bus, BusKind kind, drivers::PortReference port) {
  Carried& carried = carried_.emplace_back(0);
  if (auto* const* stream = std::get_if<ByteStream*>(&port)) {
    owned_.emplace_back(std::make_unique<LoggedStream>(log_, bus, **stream, carried));
  } else if (auto* const* can = std::get_if<CanPort*>(&port)) {
    owned_.emplace_back(std::make_unique<LoggedCan>(log_, bus, **can, carried));
  } else if (auto* const* modbus = std::get_if<ModbusPort*>(&port)) {
    owned_.emplace_back(std::make_unique<LoggedModbus>(log_, bus, kind == BusKind::modbus_tcp, **modbus, carried));
  }
  return drivers::reference(owned_.back());
}

}  // namespace footlight::app
