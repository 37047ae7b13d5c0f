// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cerrno>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include <modbus/modbus.h>

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
constexpr int kGarbledBeforeReconnect = 2;

struct CloseAndFree {
  bool close = true;  ///< false: the socket is the serial device's
  void operator()(modbus_t* context) const {
    if (close) modbus_close(context);
    modbus_free(context);
  }
};
using Context = std::unique_ptr<modbus_t, CloseAndFree>;

/// An open line or connection.
struct Connection {
  std::unique_ptr<SerialDevice> device;  ///< RTU
  Context context;
};

/// What tells a serial line from a connection.
struct Line {
  std::string name;  ///< for messages
  std::function<Result<Connection>()> open;
  bool tcp = false;
  SerialSettings serial;            ///< RTU
  std::vector<std::uint8_t> units;  ///< TCP: who a broadcast goes to
};

class LibmodbusPort final : public ModbusPort {
 public:
  explicit LibmodbusPort(Line line) : line_(std::move(line)) {}

  Status<> connect();
  SendStatus submit(const ModbusRequest& request) override;
  std::optional<ModbusReply> poll() override { return std::exchange(reply_, std::nullopt); }
  [[nodiscard]] bool busy() const override { return reply_.has_value(); }
  bool discard() override;
  [[nodiscard]] Duration wire_time(const ModbusRequest& request) const override;
  [[nodiscard]] std::string trouble() const override { return trouble_; }

 private:
  SendStatus broadcast(const ModbusRequest& request);
  int exchange(const ModbusRequest& request, std::vector<std::uint16_t>& values);
  SendStatus fail(int error, ModbusReply reply);
  void await_turn();
  void disconnect(int error);
  [[nodiscard]] modbus_t* context() const { return connection_.context.get(); }

  Line line_;
  Connection connection_;  ///< without a context: down
  SteadyClock clock_;
  Instant line_free_{};  ///< serial: silence before the next frame ends then
  int unread_ = 0;       ///< TCP: answers to a broadcast that were not awaited
  int garbled_ = 0;      ///< in a row
  std::optional<ModbusReply> reply_;
  std::string trouble_;
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

// libmodbus calls back without saying for whom; `submit` says so.
thread_local SerialDevice* turned_device = nullptr;

void turn(modbus_t* /*context*/, int speak) {
  if (turned_device == nullptr) return;
  // The library has slept for the time of the bytes.
  speak != 0 ? turned_device->speak() : turned_device->listen(Duration{});
}

void let_us_turn(modbus_t* context) {
  turned_device = nullptr;
  modbus_rtu_set_custom_rts(context, turn);
  modbus_rtu_set_rts_delay(context, 0);
  modbus_rtu_set_rts(context, MODBUS_RTU_RTS_UP);
}

/// libmodbus reports a lost wire by whatever the kernel said.
bool wire_is_gone(int error) {
  return error == EPIPE || error == ECONNRESET || error == EIO || error == EBADF || error == ENODEV || error == ENXIO ||
         error == ENOTCONN;
}

Status<> LibmodbusPort::connect() {
  auto opened = line_.open();
  if (!opened) {
    trouble_ = opened.error().message;
    return opened.error();
  }
  connection_ = std::move(opened).value();
  modbus_set_error_recovery(context(), MODBUS_ERROR_RECOVERY_NONE);  // LINK may block for ever
  modbus_set_byte_timeout(context(), 0, static_cast<std::uint32_t>(kByteTimeout / microseconds(1)));
  trouble_.clear();
  unread_ = 0;
  garbled_ = 0;
  return Done{};
}

SendStatus LibmodbusPort::submit(const ModbusRequest& request) {
  FL_CHECK(request.unit != 0 ||
           (request.function != MODBUS_FC_READ_HOLDING_REGISTERS && request.function != MODBUS_FC_READ_COILS));
  if (busy()) return SendStatus::busy;
  if (context() == nullptr && !connect()) return SendStatus::down;
  await_turn();
  turned_device = connection_.device.get();
  if (request.unit == 0) return broadcast(request);
  ModbusReply reply;
  reply.unit = request.unit;
  reply.function = request.function;
  modbus_set_slave(context(), request.unit);
  const int count = exchange(request, reply.values);
  const int error = errno;
  line_free_ = clock_.now();
  if (!line_.tcp) line_free_ += rtu_silence(line_.serial.bits_per_second, line_.serial.bits_per_character());
  if (count < 0) return fail(error, std::move(reply));
  garbled_ = 0;
  reply_ = std::move(reply);
  return SendStatus::accepted;
}

int LibmodbusPort::exchange(const ModbusRequest& request, std::vector<std::uint16_t>& values) {
  set_response_timeout(context(), wire_time(request) + (line_.tcp ? kTcpMargin : kRtuMargin));
  switch (request.function) {
    case MODBUS_FC_READ_HOLDING_REGISTERS:
      values.resize(request.count);
      return modbus_read_registers(context(), request.first_register, request.count, values.data());
    case MODBUS_FC_READ_COILS:
      return read_coils(context(), request, values);
    case MODBUS_FC_WRITE_SINGLE_COIL:
      FL_CHECK(request.values.size() == 1);
      return modbus_write_bit(context(), request.first_register, request.values[0] != 0 ? 1 : 0);
    case MODBUS_FC_WRITE_MULTIPLE_COILS:
      return write_coils(context(), request);
    case MODBUS_FC_WRITE_SINGLE_REGISTER:
      FL_CHECK(request.values.size() == 1);
      return modbus_write_register(context(), request.first_register, request.values[0]);
    case MODBUS_FC_WRITE_MULTIPLE_REGISTERS:
      FL_CHECK(request.values.size() == request.count);
      return modbus_write_registers(context(), request.first_register, request.count, request.values.data());
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
    if (modbus_send_raw_request(context(), bytes.data(), static_cast<int>(bytes.size())) < 0) {
      disconnect(errno);
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
    disconnect(error);
    return SendStatus::down;
  }
  if (error > MODBUS_ENOBASE && error < MODBUS_ENOBASE + MODBUS_EXCEPTION_MAX) {
    reply.outcome = ModbusReply::Outcome::exception;
    reply.exception_code = static_cast<std::uint8_t>(error - MODBUS_ENOBASE);
    garbled_ = 0;
  } else if (error == ETIMEDOUT) {
    reply.outcome = ModbusReply::Outcome::timeout;
  } else {
    reply.outcome = ModbusReply::Outcome::garbled;
    if (++garbled_ >= kGarbledBeforeReconnect && line_.tcp) disconnect(error);
  }
  reply_ = std::move(reply);
  return SendStatus::accepted;
}

/// Over TCP the answers to a broadcast are read, so that none of them is taken for the next one; on a serial line the
/// silence before a frame passes.
void LibmodbusPort::await_turn() {
  if (unread_ > 0) set_response_timeout(context(), kTurnaround + kTcpMargin);
  std::array<std::uint8_t, MODBUS_MAX_ADU_LENGTH> answer{};
  for (; unread_ > 0; --unread_) {
    if (modbus_receive_confirmation(context(), answer.data()) < 0) break;
  }
  unread_ = 0;
  if (line_free_ > clock_.now()) std::this_thread::sleep_for(line_free_ - clock_.now());
}

/// Never what has been sent and is still on its way out, which modbus_flush throws away, too.
bool LibmodbusPort::discard() {
  if (context() == nullptr) return false;
  if (line_.tcp) return unread_ == 0 && modbus_flush(context()) > 0;
  std::array<std::uint8_t, MODBUS_MAX_ADU_LENGTH> bytes{};
  bool any = false;
  while (connection_.device->read_some(bytes).value_or(0) > 0) any = true;
  return any;
}

void LibmodbusPort::disconnect(int error) {
  connection_ = {};
  trouble_ = line_.name + ": lost: " + modbus_strerror(error);
}

Duration LibmodbusPort::wire_time(const ModbusRequest& request) const {
  if (!line_.tcp) return rtu_wire_time(request, line_.serial.bits_per_second, line_.serial.bits_per_character());
  if (request.unit == 0) return kTcpTrip * static_cast<Duration::rep>(line_.units.size());
  return 2 * kTcpTrip + kTurnaround;
}

Result<Connection> open_rtu_line(const std::string& name, const std::string& place, const SerialSettings& settings) {
  auto device = open_serial_device(place, settings);
  if (!device) return device.error();
  const char parity = settings.characters == Characters::e1 ? 'E' : settings.characters == Characters::o1 ? 'O' : 'N';
  const int stop_bits = settings.characters == Characters::n2 ? 2 : 1;
  Context context(modbus_new_rtu(place.c_str(), settings.bits_per_second, parity, 8, stop_bits), {.close = false});
  if (!context) return device_error(name + ": not opened: " + modbus_strerror(errno));
  // The library would open the port itself, at 9,600 Bd where it does not know the speed.
  modbus_set_socket(context.get(), (*device)->poll_handle());
  if ((*device)->turned_by_us()) let_us_turn(context.get());
  return Connection{std::move(device).value(), std::move(context)};
}

}  // namespace

Result<std::unique_ptr<ModbusPort>> open_modbus_rtu(const std::string& place, const SerialSettings& settings) {
  Line line;
  line.name = "Modbus line \"" + place + "\"";
  line.serial = settings;
  line.open = [name = line.name, place, settings] { return open_rtu_line(name, place, settings); };
  auto port = std::make_unique<LibmodbusPort>(std::move(line));
  if (const auto connected = port->connect(); !connected) return connected.error();
  return std::unique_ptr<ModbusPort>(std::move(port));
}

Result<std::unique_ptr<ModbusPort>> open_modbus_tcp(const std::string& host, int port,
                                                    std::vector<std::uint8_t> units) {
  Line line;
  const std::string service = std::to_string(port);
  line.name = "Modbus device \"" + host + ":" + service + "\"";
  line.open = [name = line.name, host, service]() -> Result<Connection> {
    Connection made{nullptr, Context(modbus_new_tcp_pi(host.c_str(), service.c_str()))};
    if (made.context) set_response_timeout(made.context.get(), kConnectTimeout);
    if (made.context && modbus_connect(made.context.get()) == 0) return made;
    return device_error(name + ": not opened: " + modbus_strerror(errno) +
                        " (a device that is switched on and reached by this network)");
  };
  line.tcp = true;
  line.units = std::move(units);
  return std::unique_ptr<ModbusPort>(std::make_unique<LibmodbusPort>(std::move(line)));
}

}  // namespace footlight::drivers
