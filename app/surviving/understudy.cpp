// SPDX-License-Identifier: Apache-2.0
#include "app/surviving/understudy.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include "core/machine_time.hpp"

namespace footlight::app {
namespace {

constexpr Duration kLook = milliseconds(50);
constexpr Duration kTryAgain = milliseconds(100);

/// One connection to the lead; none while there is no socket.
class Line {
 public:
  explicit Line(const FollowSettings& settings) : settings_(settings) {}

  /// Waits for something to hear, at most so long; opens the line anew where there is none.
  void step(Duration now) {
    if (socket_.get() < 0) {
      if (now < try_at_) return wait(-1, 0);
      try_at_ = now + kTryAgain;
      dial();
      return;
    }
    wait(socket_.get(), connected_ ? POLLIN : POLLOUT);
  }

  /// A whole line, without its end.
  std::optional<std::string> take() {
    const std::size_t end = heard_.find('\n');
    if (end == std::string::npos) return std::nullopt;
    std::string line = heard_.substr(0, end);
    heard_.erase(0, end + 1);
    return line;
  }
  void say(const std::string& line) const {
    if (connected_) (void)::send(socket_.get(), line.data(), line.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  }

 private:
  void hang_up() {
    socket_ = FileDescriptor();
    connected_ = false;
    heard_.clear();
  }
  void dial() {
    addrinfo hints{};
    hints.ai_family = AF_INET;
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    if (::getaddrinfo(settings_.host.c_str(), std::to_string(settings_.port).c_str(), &hints, &found) != 0) return;
    const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> list(found, ::freeaddrinfo);
    socket_ = FileDescriptor(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    const int yes = 1;
    (void)::setsockopt(socket_.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    if (::connect(socket_.get(), list->ai_addr, list->ai_addrlen) != 0 && errno != EINPROGRESS) hang_up();
  }
  void wait(int handle, short events) {
    pollfd file{handle, events, 0};
    const int ready = ::poll(&file, handle < 0 ? 0 : 1, static_cast<int>(kLook / milliseconds(1)));
    if (ready <= 0 || handle < 0) return;
    if (!connected_) {
      int error = 0;
      socklen_t length = sizeof error;
      (void)::getsockopt(handle, SOL_SOCKET, SO_ERROR, &error, &length);
      if (error != 0) return hang_up();
      connected_ = true;
      return say(line_of({settings_.plan, settings_.token}));
    }
    std::array<char, 4096> buffer{};
    const ssize_t size = ::recv(handle, buffer.data(), buffer.size(), MSG_DONTWAIT);
    if (size > 0) heard_.append(buffer.data(), static_cast<std::size_t>(size));
    const bool gone = size == 0 || (size < 0 && errno != EAGAIN && errno != EINTR);
    if ((gone && heard_.find('\n') == std::string::npos) || heard_.size() > 64 * kLongestLeadLine) hang_up();
  }

  const FollowSettings& settings_;
  FileDescriptor socket_;
  bool connected_ = false;
  std::string heard_;
  Duration try_at_{};
};

}  // namespace

std::string FollowedLead::hear(std::string_view line, Duration now) {
  if (const auto why = refused_in(line)) return "the lead refuses this understudy: " + *why;
  if (const auto how = over_in(line)) return "the run that led has ended (" + *how + ")";
  if (const auto epoch = leads_in(line)) {
    epoch_ = std::max(epoch_, *epoch);
    heard_at_ = now;
  }
  if (auto place = place_in(line, now); place && epoch_ != 0) {
    place_ = std::move(place);
    heard_at_ = now;
  }
  return {};
}

Result<TakenOver> follow(const FollowSettings& settings) {
  Line line(settings);
  FollowedLead lead;
  bool followed = false;
  settings.note(fmt::format("waiting for the run that leads at {}:{}", settings.host, settings.port));
  while (true) {
    if (settings.stop != nullptr && settings.stop->load(std::memory_order_relaxed)) {
      return Error{ErrorKind::interrupted, "interrupted: nothing was taken over"};
    }
    line.step(machine_time());
    const Duration now = machine_time();
    while (const auto said = line.take()) {
      if (const std::string end = lead.hear(*said, now); !end.empty()) return refusal(end);
    }
    if (lead.place() && !followed) {
      followed = true;
      settings.note("following: ready to take over when the lead falls silent, or at \"lead\"");
    }
    if (lead.is_lost(now)) {
      return TakenOver{*lead.place(), lead.epoch() + kEpochsAhead,
                       fmt::format("the run that led has been silent for {:.1f} s", to_seconds(kLeadSilence))};
    }
    if (settings.wants_to_lead && settings.wants_to_lead()) {
      if (!lead.place()) {
        settings.note("nothing to take over: no lead has been heard yet");
        continue;
      }
      line.say(take_over_line(lead.epoch() + kEpochsAhead));
      return TakenOver{*lead.place(), lead.epoch() + kEpochsAhead, "the operator wants to lead"};
    }
  }
}

}  // namespace footlight::app
