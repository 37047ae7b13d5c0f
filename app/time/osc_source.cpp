// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "app/remote/osc_packet.hpp"
#include "app/surfaces/show_timecode.hpp"
#include "app/time/time_source.hpp"
#include "core/file_descriptor.hpp"

namespace footlight::app {
namespace {

constexpr std::string_view kAddress = "/footlight/time";
constexpr double kDay_s = 86'400;
constexpr int kMostDatagrams = 64;  // of one look; a flood costs itself
constexpr Duration kFixes = milliseconds(15);

/// `/footlight/time` with seconds, or with a timecode as text.
class OscTime final : public TimeSource {
 public:
  OscTime(std::string name, FileDescriptor socket, const TimeRules& rules)
      : name_(std::move(name)), socket_(std::move(socket)), rules_(rules) {}
  [[nodiscard]] std::string name() const override { return name_; }
  [[nodiscard]] int file() const override { return socket_.get(); }

  TimeNews read(Instant now, const ShowState& /*show*/) override {
    TimeNews news;
    std::array<std::byte, 2048> datagram{};
    for (int i = 0; i < kMostDatagrams; ++i) {
      const ssize_t size = ::recv(socket_.get(), datagram.data(), datagram.size(), MSG_DONTWAIT);
      if (size < 0) break;
      const auto messages = read_osc(std::span(datagram).first(static_cast<std::size_t>(size)));
      if (!messages) continue;
      for (const OscMessage& message : *messages) take(message, now, news);
    }
    return news;
  }

 private:
  void take(const OscMessage& message, Instant now, TimeNews& news) {
    if (message.address != kAddress || message.values.empty()) return;
    const OscValue& value = message.values.front();
    std::optional<Duration> position;
    if (const auto* whole = std::get_if<std::int32_t>(&value)) position = in_seconds(*whole);
    if (const auto* real = std::get_if<double>(&value)) position = in_seconds(*real);
    if (const auto* text = std::get_if<std::string>(&value)) {
      const auto code = parse_timecode(*text, rules_.rate);
      if (code) position = time_of(*code);
    }
    if (!position) {
      if (!std::exchange(told_wrong_, true)) {
        news.alarms.push_back(
            fmt::format("{}: {} without seconds or a timecode of {} frames", name_, kAddress, to_text(rules_.rate)));
      }
      return;
    }
    // A stream that is faster than lamps tells nothing more.
    if (fixed_at_ && now - *fixed_at_ < kFixes) return;
    fixed_at_ = now;
    news.fixes.push_back({now, in_show(*position, rules_)});
  }
  static std::optional<Duration> in_seconds(double value_s) {
    if (!std::isfinite(value_s) || value_s < 0 || value_s > kDay_s) return std::nullopt;
    return seconds(value_s);
  }

  std::string name_;
  FileDescriptor socket_;
  TimeRules rules_;
  std::optional<Instant> fixed_at_;
  bool told_wrong_ = false;
};

}  // namespace

Result<std::unique_ptr<TimeSource>> open_osc_time(const std::string& address, const TimeRules& rules) {
  const std::size_t colon = address.rfind(':');
  const std::string host = colon == std::string::npos ? "127.0.0.1" : address.substr(0, colon);
  const std::string number = colon == std::string::npos ? address : address.substr(colon + 1);
  int port = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), port);
  sockaddr_in place{};
  place.sin_family = AF_INET;
  if (error != std::errc{} || end != number.data() + number.size() || port < 1 || port > 65'535 ||
      ::inet_pton(AF_INET, host.c_str(), &place.sin_addr) != 1) {
    return input_error(
        fmt::format("osc:{}: a UDP port is wanted, alone (then only this machine is heard) or with the "
                    "address to hear at, as osc:7000 or osc:192.168.1.10:7000",
                    address));
  }
  place.sin_port = htons(static_cast<std::uint16_t>(port));
  FileDescriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (socket.get() < 0 || ::bind(socket.get(), reinterpret_cast<const sockaddr*>(&place), sizeof place) != 0) {
    return device_error(fmt::format("osc:{}: {}", address, std::strerror(errno)));
  }
  return std::unique_ptr<TimeSource>(std::make_unique<OscTime>("osc " + address, std::move(socket), rules));
}

}  // namespace footlight::app
