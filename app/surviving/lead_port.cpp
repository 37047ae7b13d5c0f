// SPDX-License-Identifier: Apache-2.0
#include "app/surviving/lead_port.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <system_error>
#include <utility>

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/surfaces/run_desk.hpp"
#include "core/machine_time.hpp"
#include "core/secret.hpp"

namespace footlight::app {
namespace {

constexpr std::size_t kTokenBytes = 32;

std::string words_of(int error) { return std::generic_category().message(error); }

/// @return false when it does not take all of it at once: it is slow, or gone
bool say(const FileDescriptor& socket, const std::string& line) {
  return ::send(socket.get(), line.data(), line.size(), MSG_NOSIGNAL | MSG_DONTWAIT) ==
         static_cast<ssize_t>(line.size());
}

}  // namespace

bool is_loopback(const std::string& address) {
  in_addr four{};
  return ::inet_pton(AF_INET, address.c_str(), &four) == 1 && (ntohl(four.s_addr) >> 24U) == 127;
}

Result<std::string> token_in(const std::string& file) {
  struct stat facts {};
  if (::stat(file.c_str(), &facts) != 0) {
    std::array<unsigned char, kTokenBytes> chance{};
    if (::getrandom(chance.data(), chance.size(), 0) != static_cast<ssize_t>(chance.size())) {
      return internal_error("no random numbers: " + words_of(errno));
    }
    std::string token;
    for (const unsigned char byte : chance) token += fmt::format("{:02x}", byte);
    const FileDescriptor out(::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
    const std::string line = token + "\n";
    if (out.get() < 0 || ::write(out.get(), line.data(), line.size()) != static_cast<ssize_t>(line.size())) {
      return input_error(fmt::format("cannot write the token '{}': {}", file, words_of(errno)));
    }
    return token;
  }
  if ((facts.st_mode & 077U) != 0) {
    return input_error(fmt::format("the token '{}' may be read by others (chmod 600 {})", file, file));
  }
  std::string token;
  std::ifstream(file) >> token;
  if (token.size() < kTokenBytes) {
    return input_error(
        fmt::format("the token '{}' is too short: at least {} characters (remove the file, and a good one is made)",
                    file, kTokenBytes));
  }
  return token;
}

Result<std::unique_ptr<LeadPort>> LeadPort::open(Settings settings) {
  const auto refused = [&](const std::string& why) {
    return input_error(fmt::format("--lead {}:{}: {}", settings.address, settings.port, why));
  };
  if (settings.token.empty() && !is_loopback(settings.address)) {
    return refused("an address that other machines reach needs --lead-token");
  }
  sockaddr_in us{};
  us.sin_family = AF_INET;
  us.sin_port = htons(static_cast<std::uint16_t>(settings.port));
  if (::inet_pton(AF_INET, settings.address.c_str(), &us.sin_addr) != 1) {
    return refused("an IPv4 address is wanted, as in 127.0.0.1 or 192.168.1.7");
  }
  FileDescriptor listener(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const int yes = 1;
  (void)::setsockopt(listener.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  if (::bind(listener.get(), reinterpret_cast<const sockaddr*>(&us), sizeof us) != 0 ||
      ::listen(listener.get(), static_cast<int>(kMostClients)) != 0) {
    return refused(words_of(errno));
  }
  socklen_t length = sizeof us;
  (void)::getsockname(listener.get(), reinterpret_cast<sockaddr*>(&us), &length);
  return std::unique_ptr<LeadPort>(new LeadPort(std::move(settings), std::move(listener), ntohs(us.sin_port)));
}

void LeadPort::look(const DeskView& view, RunDesk& desk) {
  std::vector<RunEvent> news;
  {
    const std::lock_guard lock(mutex_);
    news.swap(news_);
    emergency_hold_ = view.emergency_hold;
    readiness_ = view.readiness.outlives;
    looked_ = true;
  }
  for (RunEvent& event : news) desk.tell(std::move(event));
}

void LeadPort::tell(RunEvent::Kind kind, std::string text) {
  constexpr std::size_t kMostNews = 64;  // a desk that hears nothing for so long has other troubles
  const std::lock_guard lock(mutex_);
  if (news_.size() < kMostNews) news_.push_back({kind, std::move(text)});
}

void LeadPort::beat(const ShowState& state) {
  const Duration now = machine_time();
  const Instant at = state.at;
  machine_ahead_ = std::min(machine_ahead_, now - at.time_since_epoch());
  // Only the cue thread's own words are passed on: when it falls silent, so does this.
  DeskView view;
  view.show = state;
  bool looked = false;
  std::string next_plan;
  {
    const std::lock_guard lock(mutex_);
    next_plan.swap(next_plan_);
    looked = looked_;
    view.emergency_hold = emergency_hold_;
    view.readiness.outlives = readiness_;
  }
  if (!next_plan.empty()) go_over(next_plan);
  welcome(now);
  const bool due = looked && (said_at_ == Instant::min() || at - said_at_ >= kLeadEvery);
  std::string line;
  if (due) {
    said_at_ = at;
    line = place_line(place_of(view, machine_ahead_), now);
  }
  std::erase_if(clients_, [&](Client& client) {
    return !listen_to(client, now) || (due && client.follows && !say(client.socket, line));
  });
}

void LeadPort::welcome(Duration now) {
  while (true) {
    FileDescriptor socket(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (socket.get() < 0) return;
    if (clients_.size() >= kMostClients) continue;  // hung up on
    const int yes = 1;
    (void)::setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    clients_.push_back({std::move(socket), {}, false, now});
  }
}

bool LeadPort::listen_to(Client& client, Duration now) {
  if (!client.follows && now - client.since > kFirstLineWithin) return false;
  std::array<char, 512> buffer{};
  const ssize_t size = ::recv(client.socket.get(), buffer.data(), buffer.size(), MSG_DONTWAIT);
  if (size == 0 || (size < 0 && errno != EAGAIN && errno != EINTR)) return false;
  if (size > 0) client.heard.append(buffer.data(), static_cast<std::size_t>(size));
  for (std::size_t end = client.heard.find('\n'); end != std::string::npos; end = client.heard.find('\n')) {
    const std::string line = client.heard.substr(0, end);
    client.heard.erase(0, end + 1);
    if (!take_line(client, line)) return false;
  }
  return client.heard.size() <= kLongestLeadLine;
}

bool LeadPort::take_line(Client& client, std::string_view line) {
  if (const auto epoch = take_over_in(line); epoch && client.follows && *epoch > settings_.epoch) {
    taken_over_.store(*epoch, std::memory_order_relaxed);
    return true;
  }
  const auto request = follow_request(line);
  if (!request || client.follows) return false;
  if (!settings_.token.empty() && !same_secret(settings_.token, request->token)) {
    (void)say(client.socket, refused_line("another token is wanted"));
    tell(RunEvent::Kind::alarm, "an understudy without the right token was refused");
    return false;
  }
  if (request->plan != settings_.plan) {
    (void)say(client.socket, refused_line("another plan is led here"));
    tell(RunEvent::Kind::alarm, "an understudy with another plan was refused");
    return false;
  }
  client.follows = true;
  tell(RunEvent::Kind::note, "an understudy follows");
  return say(client.socket, leads_line(settings_.epoch));
}

void LeadPort::plan_is(const std::string& digest) {
  const std::lock_guard lock(mutex_);
  next_plan_ = digest;
}

void LeadPort::go_over(const std::string& digest) {
  if (digest == settings_.plan) return;
  settings_.plan = digest;
  const std::size_t sent_away = std::erase_if(clients_, [](const Client& client) {
    if (client.follows) (void)say(client.socket, refused_line("another plan is led from now on: begin it again"));
    return client.follows;
  });
  if (sent_away > 0) {
    tell(RunEvent::Kind::alarm, "the understudy has the plan before this one: begin it again with these files");
  }
}

void LeadPort::close(const std::string& how) {
  for (const Client& client : clients_) {
    if (client.follows) (void)say(client.socket, over_line(how));
  }
  clients_.clear();
}

}  // namespace footlight::app
