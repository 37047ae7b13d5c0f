// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cerrno>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include <modbus/modbus.h>
#include <poll.h>

#include "core/check.hpp"
#include "core/clock.hpp"
#include "drivers/transports/modbus_port.hpp"

namespace footlight::drivers {
namespace {

constexpr Duration kConnectTimeout = milliseconds(500);
constexpr Duration kTurnaround = milliseconds(5);
constexpr Duration kRtuMargin = milliseconds(50);  // adapters hold bytes back for up to 16 ms, the machine for more
constexpr Duration kTcpMargin = milliseconds(100);
constexpr Duration kTcpTrip = microseconds(500);  // of one request through a local network
constexpr Duration kByteTimeout = milliseconds(20);
constexpr int kQuietMs = 20;  // a line that is silent for so long has nothing more to say
constexpr int kMostQuietRounds = 10;
constexpr int kGarbledBeforeReconnect = 2;

struct FreeModbus {
  void operator()(modbus_t* context) const {
    modbus_close(context);
    modbus_free(context);
  }
};
using Context = std::unique_ptr<modbus_t, FreeModbus>;

/// What tells a serial line from a connection.
struct Line {
  std::string name;  ///< for messages
  std::string hint;
  std::function<modbus_t*()> make;
  bool tcp = false;
  int bits_per_second = 0;          ///< serial
  std::vector<std::uint8_t> units;  ///< TCP: who a broadcast goes to
};

class LibmodbusPort final : public ModbusPort {
 public:
  explicit LibmodbusPort(Line line) : line_(std::move(line)) {}

  Status<> connect();
  SendStatus submit(const ModbusRequest& request) override;
  std::optional<ModbusReply> poll() override { return std::exchange(reply_, std::nullopt); }
  [[nodiscard]] bool busy() const override { return reply_.has_value(); }
  bool discard() override { return false; }
  [[nodiscard]] Duration wire_time(const ModbusRequest& request) const override;

 private:
  SendStatus broadcast(const ModbusRequest& request);
  int exchange(const ModbusRequest& request, std::vector<std::uint16_t>& values);
  SendStatus fail(int error, ModbusReply reply);
  void settle();
  void await_quiet();
  void disconnect();

  Line line_;
  Context context_;
  SteadyClock clock_;
  Instant line_free_{};  ///< serial: silence before the next frame ends then
  int unread_ = 0;       ///< TCP: answers to a broadcast that were not awaited
  int garbled_ = 0;      ///< in a row
  std::optional<ModbusReply> reply_;
};

void set_response_timeout(modbus_t* context, Duration timeout) {
  const auto us = static_cast<std::uint32_t>(timeout / microseconds(1));
  modbus_set_response_timeout(context, us / 1'000'000, us % 1'000'000);
}

/// Eight coils a byte, the first in the lowest bit.
std::vector<std::uint8_t> packed_coils(const std::vector<std::uint16_t>& values) {
  std::vector<std::uint8_t> bytes((values.size() + 7) / 8);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] != 0) bytes[i / 8] = static_cast<std::uint8_t>(bytes[i / 8] | (1U << (i % 8)));
  }
  return bytes;
}

int read_coils(modbus_t* context, const ModbusRequest& request, std::vector<std::uint16_t>& values) {
  std::vector<std::uint8_t> coils(request.count);
  const int count = modbus_read_bits(context, request.first_register, request.count, coils.data());
  values.assign(coils.begin(), coils.end());
  return count;
}

int write_coils(modbus_t* context, const ModbusRequest& request) {
  FL_CHECK(request.values.size() == request.count);
  const std::vector<std::uint8_t> coils(request.values.begin(), request.values.end());
  return modbus_write_bits(context, request.first_register, request.count, coils.data());
}

/// The request behind its address, without check sum: what modbus_send_raw_request takes.
std::vector<std::uint8_t> raw_request(std::uint8_t unit, const ModbusRequest& request) {
  const auto high = [](std::uint16_t word) { return static_cast<std::uint8_t>(word >> 8); };
  const auto low = [](std::uint16_t word) { return static_cast<std::uint8_t>(word & 0xFF); };
  std::vector<std::uint8_t> bytes{unit, request.function, high(request.first_register), low(request.first_register)};
  if (request.function == MODBUS_FC_WRITE_MULTIPLE_COILS) {
    const std::vector<std::uint8_t> packed = packed_coils(request.values);
    bytes.insert(bytes.end(), {high(request.count), low(request.count), static_cast<std::uint8_t>(packed.size())});
    bytes.insert(bytes.end(), packed.begin(), packed.end());
    return bytes;
  }
  if (request.function == MODBUS_FC_WRITE_MULTIPLE_REGISTERS) {
    bytes.insert(bytes.end(), {high(request.count), low(request.count), static_cast<std::uint8_t>(2 * request.count)});
  }
  for (const std::uint16_t value : request.values) bytes.insert(bytes.end(), {high(value), low(value)});
  return bytes;
}

/// libmodbus reports a lost wire by whatever the kernel said.
bool wire_is_gone(int error) {
  return error == EPIPE || error == ECONNRESET || error == EIO || error == EBADF || error == ENODEV || error == ENXIO ||
         error == ENOTCONN;
}

Status<> LibmodbusPort::connect() {
  Context context(line_.make());
  if (context) {
    modbus_set_error_recovery(context.get(), MODBUS_ERROR_RECOVERY_NONE);  // LINK may block for ever
    set_response_timeout(context.get(), kConnectTimeout);
    const auto byte_us = static_cast<std::uint32_t>(kByteTimeout / microseconds(1));
    modbus_set_byte_timeout(context.get(), 0, byte_us);
  }
  if (!context || modbus_connect(context.get()) != 0) {
    return device_error(line_.name + ": not opened: " + modbus_strerror(errno) + " (" + line_.hint + ")");
  }
  context_ = std::move(context);
  unread_ = 0;
  garbled_ = 0;
  return Done{};
}

SendStatus LibmodbusPort::submit(const ModbusRequest& request) {
  FL_CHECK(request.unit != 0 ||
           (request.function != MODBUS_FC_READ_HOLDING_REGISTERS && request.function != MODBUS_FC_READ_COILS));
  if (busy()) return SendStatus::busy;
  if (!context_ && !connect()) return SendStatus::down;
  settle();
  if (request.unit == 0) return broadcast(request);
  ModbusReply reply;
  reply.unit = request.unit;
  reply.function = request.function;
  modbus_set_slave(context_.get(), request.unit);
  const int count = exchange(request, reply.values);
  const int error = errno;
  line_free_ = clock_.now() + (line_.tcp ? Duration{} : rtu_silence(line_.bits_per_second));
  if (count < 0) return fail(error, std::move(reply));
  garbled_ = 0;
  reply_ = std::move(reply);
  return SendStatus::accepted;
}

int LibmodbusPort::exchange(const ModbusRequest& request, std::vector<std::uint16_t>& values) {
  set_response_timeout(context_.get(), wire_time(request) + (line_.tcp ? kTcpMargin : kRtuMargin));
  switch (request.function) {
    case MODBUS_FC_READ_HOLDING_REGISTERS:
      values.resize(request.count);
      return modbus_read_registers(context_.get(), request.first_register, request.count, values.data());
    case MODBUS_FC_READ_COILS:
      return read_coils(context_.get(), request, values);
    case MODBUS_FC_WRITE_SINGLE_COIL:
      FL_CHECK(request.values.size() == 1);
      return modbus_write_bit(context_.get(), request.first_register, request.values[0] != 0 ? 1 : 0);
    case MODBUS_FC_WRITE_MULTIPLE_COILS:
      return write_coils(context_.get(), request);
    case MODBUS_FC_WRITE_SINGLE_REGISTER:
      FL_CHECK(request.values.size() == 1);
      return modbus_write_register(context_.get(), request.first_register, request.values[0]);
    case MODBUS_FC_WRITE_MULTIPLE_REGISTERS:
      FL_CHECK(request.values.size() == request.count);
      return modbus_write_registers(context_.get(), request.first_register, request.count, request.values.data());
    default:
      FL_CHECK(false && "a function that the drivers use");
      return -1;
  }
}

/// A broadcast write of libmodbus waits for an answer that never comes: the raw frame is sent instead.
SendStatus LibmodbusPort::broadcast(const ModbusRequest& request) {
  const std::vector<std::uint8_t> everybody{0};
  for (const std::uint8_t unit : line_.tcp ? line_.units : everybody) {
    const std::vector<std::uint8_t> bytes = raw_request(unit, request);
    if (modbus_send_raw_request(context_.get(), bytes.data(), static_cast<int>(bytes.size())) < 0) {
      disconnect();
      return SendStatus::down;
    }
    if (line_.tcp) ++unread_;
  }
  line_free_ = clock_.now() + (line_.tcp ? Duration{} : wire_time(request));
  return SendStatus::accepted;
}

SendStatus LibmodbusPort::fail(int error, ModbusReply reply) {
  reply.values.clear();
  if (wire_is_gone(error)) {
    disconnect();
    return SendStatus::down;
  }
  if (error > MODBUS_ENOBASE && error < MODBUS_ENOBASE + MODBUS_EXCEPTION_MAX) {
    reply.outcome = ModbusReply::Outcome::exception;
    reply.exception_code = static_cast<std::uint8_t>(error - MODBUS_ENOBASE);
    garbled_ = 0;
  } else if (error == ETIMEDOUT) {
    reply.outcome = ModbusReply::Outcome::timeout;
    await_quiet();
  } else {
    reply.outcome = ModbusReply::Outcome::garbled;
    await_quiet();
    if (++garbled_ >= kGarbledBeforeReconnect && line_.tcp) disconnect();
  }
  reply_ = std::move(reply);
  return SendStatus::accepted;
}

/// Lets what an earlier request may still bring pass, so that nothing old is taken for the next answer.
void LibmodbusPort::settle() {
  if (unread_ > 0) set_response_timeout(context_.get(), kTurnaround + kTcpMargin);
  std::array<std::uint8_t, MODBUS_MAX_ADU_LENGTH> answer{};
  for (; unread_ > 0; --unread_) {
    if (modbus_receive_confirmation(context_.get(), answer.data()) < 0) break;
  }
  unread_ = 0;
  if (line_free_ > clock_.now()) std::this_thread::sleep_for(line_free_ - clock_.now());
  modbus_flush(context_.get());
}

/// After one late reply every later request would be answered by the reply before it, without an error.
void LibmodbusPort::await_quiet() {
  for (int round = 0; round < kMostQuietRounds; ++round) {
    pollfd file{modbus_get_socket(context_.get()), POLLIN, 0};
    if (::poll(&file, 1, kQuietMs) <= 0) return;
    if (modbus_flush(context_.get()) <= 0) return;
  }
}

void LibmodbusPort::disconnect() { context_.reset(); }

Duration LibmodbusPort::wire_time(const ModbusRequest& request) const {
  if (!line_.tcp) return rtu_wire_time(request, line_.bits_per_second);
  if (request.unit == 0) return kTcpTrip * static_cast<Duration::rep>(line_.units.size());
  return 2 * kTcpTrip + kTurnaround;
}

Result<std::unique_ptr<ModbusPort>> open(Line line) {
  auto port = std::make_unique<LibmodbusPort>(std::move(line));
  if (const auto connected = port->connect(); !connected) return connected.error();
  return std::unique_ptr<ModbusPort>(std::move(port));
}

}  // namespace

Result<std::unique_ptr<ModbusPort>> open_modbus_rtu(const std::string& path, int bits_per_second) {
  Line line;
  line.name = "Modbus line \"" + path + "\"";
  line.hint = "a port as listed in /dev/serial/by-id, and membership of the group dialout";
  line.make = [path, bits_per_second] { return modbus_new_rtu(path.c_str(), bits_per_second, 'E', 8, 1); };
  line.bits_per_second = bits_per_second;
  return open(std::move(line));
}

Result<std::unique_ptr<ModbusPort>> open_modbus_tcp(const std::string& host, int port,
                                                    std::vector<std::uint8_t> units) {
  Line line;
  const std::string service = std::to_string(port);
  line.name = "Modbus device \"" + host + ":" + service + "\"";
  line.hint = "a device that is switched on and reached by this network";
  line.make = [host, service] { return modbus_new_tcp_pi(host.c_str(), service.c_str()); };
  line.tcp = true;
  line.units = std::move(units);
  return open(std::move(line));
}

}  // namespace footlight::drivers
