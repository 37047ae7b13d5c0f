// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cstring>
#include <utility>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "app/remote/osc_packet.hpp"
#include "app/surfaces/show_timecode.hpp"
#include "app/time/time_out.hpp"
#include "app/time/time_source.hpp"
#include "core/file_descriptor.hpp"

namespace footlight::app {
namespace {

constexpr Duration kPeriod = milliseconds(40);

class OscTimeOut final : public TimeOut {
 public:
  OscTimeOut(FileDescriptor socket, const sockaddr_in& to, const TimeRules& rules)
      : socket_(std::move(socket)), to_(to), rules_(rules) {}

  void look(const DeskView& view, RunDesk& /*desk*/) override {
    if (view.show.at - told_at_ < kPeriod) return;
    told_at_ = view.show.at;
    const controller::RunningTime time = running_time(view.show, rules_, view.show.at);
    const Duration now = time.position_at(run_ == nullptr ? view.show.at : run_->now());
    const auto bytes = osc_bundle({{"/footlight/time", {to_seconds(now)}},
                                   {"/footlight/timecode", {timecode_text(now, rules_.rate)}},
                                   {"/footlight/runs", {std::int32_t{time.runs}}}});
    // Who does not listen does not hear.
    (void)::sendto(socket_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT, reinterpret_cast<const sockaddr*>(&to_),
                   sizeof to_);
  }

 private:
  FileDescriptor socket_;
  sockaddr_in to_;
  TimeRules rules_;
  Instant told_at_ = Instant(seconds(-1));
};

}  // namespace

Result<std::unique_ptr<TimeOut>> open_osc_time_out(const std::string& address, const TimeRules& rules) {
  const std::size_t colon = address.rfind(':');
  const std::string host = address.substr(0, colon);
  const std::string number = colon == std::string::npos ? "" : address.substr(colon + 1);
  int port = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), port);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  if (error != std::errc{} || end != number.data() + number.size() || port < 1 || port > 65'535 ||
      ::inet_pton(AF_INET, host.c_str(), &to.sin_addr) != 1) {
    return input_error(fmt::format("osc:{}: an address and a UDP port are wanted, as osc:192.168.1.20:7000", address));
  }
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  if (osc_bytes({"/footlight/time", {0.0}}).empty()) {
    return device_error("osc:" + address +
                        ": this program was built without liblo (install liblo-dev and build again)");
  }
  FileDescriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (socket.get() < 0) return device_error(fmt::format("osc:{}: {}", address, std::strerror(errno)));
  return std::unique_ptr<TimeOut>(std::make_unique<OscTimeOut>(std::move(socket), to, rules));
}

}  // namespace footlight::app
