// SPDX-License-Identifier: Apache-2.0
#include "app/remote/osc_surface.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <string_view>
#include <system_error>
#include <utility>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>

namespace footlight::app {
namespace {

constexpr Duration kTellLost = milliseconds(1000);
// Of a look: what is beyond them waits in the kernel, as far as its buffer goes.
constexpr int kMostReads = 2048;
constexpr std::size_t kMostBytes = std::size_t{1} << 19U;
constexpr int kKernelBuffer = 1 << 22;
constexpr std::size_t kMostPending = 256;
constexpr std::size_t kLargestDatagram = 8192;

struct SocketAddress {
  sockaddr_storage bytes{};
  socklen_t size = sizeof(sockaddr_storage);
  [[nodiscard]] const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&bytes); }
  [[nodiscard]] sockaddr* get() { return reinterpret_cast<sockaddr*>(&bytes); }
};

/// Whose messages have not shown the token, for the guard.
std::string stranger(const config::NetworkPlace& client) { return "stranger " + client.address; }

SocketAddress address_of(const config::NetworkPlace& place) {
  SocketAddress out;
  auto* four = reinterpret_cast<sockaddr_in*>(&out.bytes);
  auto* six = reinterpret_cast<sockaddr_in6*>(&out.bytes);
  if (::inet_pton(AF_INET, place.address.c_str(), &four->sin_addr) == 1) {
    four->sin_family = AF_INET;
    four->sin_port = htons(place.port);
    out.size = sizeof(sockaddr_in);
  } else if (::inet_pton(AF_INET6, place.address.c_str(), &six->sin6_addr) == 1) {
    six->sin6_family = AF_INET6;
    six->sin6_port = htons(place.port);
    out.size = sizeof(sockaddr_in6);
  }
  return out;
}

config::NetworkPlace place_of(const SocketAddress& address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (address.bytes.ss_family == AF_INET6) {
    const auto* six = reinterpret_cast<const sockaddr_in6*>(&address.bytes);
    // A socket of version 6 hears version 4, too, under mapped addresses.
    const auto* four = six->sin6_addr.s6_addr + 12;
    if (IN6_IS_ADDR_V4MAPPED(&six->sin6_addr)) {
      ::inet_ntop(AF_INET, four, text.data(), text.size());
    } else {
      ::inet_ntop(AF_INET6, &six->sin6_addr, text.data(), text.size());
    }
    return {text.data(), ntohs(six->sin6_port)};
  }
  const auto* four = reinterpret_cast<const sockaddr_in*>(&address.bytes);
  ::inet_ntop(AF_INET, &four->sin_addr, text.data(), text.size());
  return {text.data(), ntohs(four->sin_port)};
}

/// Whether there is a HOLD, a button or a gate in it, as far as its bytes tell. What is said of anything else after a
/// client's budget is spent need not be read.
bool may_hold(std::span<const std::byte> datagram) {
  const std::string_view bytes(reinterpret_cast<const char*>(datagram.data()), datagram.size());
  constexpr std::array<std::string_view, 7> kWords{"/stop",        "/pause", "/panic", "/footlight/b",
                                                   "/footlight/g", "hold",   "HOLD"};
  return std::ranges::any_of(kWords, [&](std::string_view word) { return bytes.find(word) != std::string_view::npos; });
}

/// "hold", "HOLD": as `Orders` reads it.
bool is_hold(const RemoteCall& call) {
  if (call.kind == RemoteCall::Kind::hold) return true;
  if (call.kind != RemoteCall::Kind::order || call.text.size() != 4) return false;
  return std::ranges::equal(call.text, std::string_view("hold"), {},
                            [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
}

Result<FileDescriptor> listen_at(const config::NetworkPlace& place) {
  const SocketAddress address = address_of(place);
  FileDescriptor socket(::socket(address.bytes.ss_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (socket.get() < 0 || ::bind(socket.get(), address.get(), address.size) != 0) {
    return device_error(fmt::format("OSC: UDP port {} of {}: {} (a port that nobody uses, an address of this machine)",
                                    place.port, place.address, std::generic_category().message(errno)));
  }
  // What overflows it before it is read is lost to everybody, HOLD or not. The second needs a privilege.
  (void)::setsockopt(socket.get(), SOL_SOCKET, SO_RCVBUF, &kKernelBuffer, sizeof kKernelBuffer);
  (void)::setsockopt(socket.get(), SOL_SOCKET, SO_RCVBUFFORCE, &kKernelBuffer, sizeof kKernelBuffer);
  return socket;
}

}  // namespace

Result<std::unique_ptr<OscSurface>> OscSurface::open(const config::OscRemote& settings, const Show& show,
                                                     const Plan& plan, const RunDesk& desk, Interlocks& interlocks,
                                                     Panel& panel, const Clock& clock, bool listens) {
  if (osc_bytes({"/go"}).empty()) return read_osc({}).error();
  std::string token;
  if (!settings.token_file.empty()) {
    auto read = read_osc_token(settings.token_file);
    if (!read) return std::move(read).error();
    token = std::move(read).value();
  }
  auto socket = listen_at(settings.listen);
  if (!socket) return std::move(socket).error();
  return std::unique_ptr<OscSurface>(new OscSurface(settings, std::move(token), std::move(socket).value(), show, plan,
                                                    desk, interlocks, panel, clock, listens));
}

OscSurface::OscSurface(const config::OscRemote& settings, std::string token, FileDescriptor socket, const Show& show,
                       const Plan& plan, const RunDesk& desk, Interlocks& interlocks, Panel& panel, const Clock& clock,
                       bool listens)
    : settings_(settings),
      door_(settings.from, std::move(token)),
      socket_(std::move(socket)),
      text_(show, plan, desk.orders().plays()),
      desk_(desk),
      interlocks_(interlocks),
      panel_(panel),
      clock_(clock),
      listens_(listens) {}

int OscSurface::file() const {
  // While somebody floods nobody is woken for it: the next look takes what there is.
  return guard_.floods(clock_.now()) ? -1 : socket_.get();
}

void OscSurface::look(const DeskView& view, RunDesk& desk) {
  read(view, desk);
  tell_lost(desk);
  const Instant now = clock_.now();
  if (settings_.state.empty() || now - state_told_ < seconds(1 / settings_.rate_hz)) return;
  state_told_ = now;
  const auto bytes = osc_bundle(state_of(view));
  for (const config::NetworkPlace& to : settings_.state) send(to, bytes);
}

void OscSurface::read(const DeskView& view, RunDesk& desk) {
  std::array<std::byte, kLargestDatagram> buffer{};
  std::size_t bytes = 0;
  guard_.begin_look();
  for (int reads = 0; reads < kMostReads && bytes < kMostBytes; ++reads) {
    SocketAddress from;
    const ssize_t size = ::recvfrom(socket_.get(), buffer.data(), buffer.size(), 0, from.get(), &from.size);
    if (size < 0) break;  // nothing more; what the network reports of replies is nobody's concern
    const config::NetworkPlace client = place_of(from);
    if (!door_.knows(client.address)) continue;
    bytes += static_cast<std::size_t>(size);
    take(std::span(buffer.data(), static_cast<std::size_t>(size)), client, view, desk);
  }
  settle_inputs(desk);
}

void OscSurface::take(std::span<const std::byte> datagram, const config::NetworkPlace& client, const DeskView& view,
                      RunDesk& desk) {
  const Instant now = clock_.now();
  if (guard_.full(client.address, now) && guard_.full(stranger(client), now) && !may_hold(datagram)) {
    return guard_.lose(now);
  }
  auto messages = read_osc(datagram);
  if (!messages) {
    if (guard_.take(stranger(client), now)) reply(client, "", "error", messages.error().message);
    return;
  }
  for (OscMessage& message : *messages) carry_out(std::move(message), client, view, desk);
}

void OscSurface::carry_out(OscMessage message, const config::NetworkPlace& client, const DeskView& view,
                           RunDesk& desk) {
  const Instant now = clock_.now();
  const std::string address = message.address;
  if (address == "/connect") {
    if (!guard_.take(stranger(client), now)) return;
    const OscAsked asked = asked_by(message);
    const bool right = asked.kind == OscAsked::Kind::connect && door_.connect(client, asked.call.text, now);
    return reply(client, address, right ? "ok" : "denied", right ? "" : "the token is another one");
  }
  if (!door_.lets_in(client, message, now)) {
    if (!guard_.take(stranger(client), now)) return;
    return reply(client, address, "denied", "/connect with the token, or the token as the last argument");
  }
  const OscAsked asked = asked_by(message);
  const bool holds = asked.kind == OscAsked::Kind::call && is_hold(asked.call);
  const bool input = asked.kind == OscAsked::Kind::input;
  if (holds ? !guard_.take_hold(now) : !input && !guard_.take(client.address, now)) return;
  switch (asked.kind) {
    case OscAsked::Kind::call:
      return say(asked.call, address, client, view, desk);
    case OscAsked::Kind::input:
      if (hear(asked.input, client, desk) || !guard_.take(client.address, now)) return;
      return reply(
          client, address, "error",
          std::string("no ") + (asked.input.gate ? "gate" : "button") + " \"" + asked.input.name + "\" is told by OSC");
    case OscAsked::Kind::state:
      return send({client.address, settings_.reply_port != 0 ? settings_.reply_port : client.port},
                  osc_bundle(state_of(view)));
    case OscAsked::Kind::connect:
    case OscAsked::Kind::nothing:
      return;
    case OscAsked::Kind::unknown:
      return reply(client, address, "error", asked.why);
  }
}

bool OscSurface::hear(const OscInput& input, const config::NetworkPlace& client, RunDesk& desk) {
  const Instant now = clock_.now();
  if (!input.gate && !panel_.holds(input.name)) {
    // Each press is an order, and counts as one. It is said again and again: no replies.
    return !panel_.is_told(input.name)
               ? false
               : !guard_.take(client.address, now) || panel_.tell_button(input.name, input.on, now, desk);
  }
  const auto waiting = levels_.find({input.gate, input.name});
  if (waiting != levels_.end()) {
    // Closed is what a gate has to be said to be each time, pressed is what a button has to be said to be once.
    waiting->second = input.gate ? waiting->second && input.on : waiting->second || input.on;
    return true;
  }
  if (!guard_.full("input " + client.address, now)) {
    (void)guard_.take("input " + client.address, now);
    return input.gate ? interlocks_.tell_gate(input.name, input.on, now)
                      : panel_.tell_button(input.name, input.on, now, desk);
  }
  if (input.gate && !interlocks_.is_told(input.name)) return false;
  levels_[{input.gate, input.name}] = input.on;
  return true;
}

void OscSurface::settle_inputs(RunDesk& desk) {
  const Instant now = clock_.now();
  for (const auto& [input, on] : std::exchange(levels_, {})) {
    if (input.first) {
      (void)interlocks_.tell_gate(input.second, on, now);
    } else {
      (void)panel_.tell_button(input.second, on, now, desk);
    }
  }
}

void OscSurface::say(const RemoteCall& call, const std::string& address, const config::NetworkPlace& client,
                     const DeskView& view, RunDesk& desk) {
  const auto words = words_of(call, view, desk_.orders().plays());
  const Speaker who{controller::GoSource::network, "osc " + client.address};
  if (pending_.size() == kMostPending) pending_.pop_front();
  pending_.push_back({client, who.name, words ? words.value() : address, address});
  if (!words) return desk.tell(refusal_of(address, who, words.error().message));
  desk.say(words.value(), who);
}

void OscSurface::told(const RunEvent& event) {
  if (event.kind == RunEvent::Kind::alarm) {
    for (const config::NetworkPlace& to : settings_.state) send(to, osc_bytes({"/footlight/alarm", {event.text}}));
  }
  if (event.kind != RunEvent::Kind::answer) return;
  const auto asked = std::ranges::find_if(pending_, [&](const Pending& one) {
    return one.who == event.who.name && (one.order == event.order || (one.order.empty() && event.order == "go"));
  });
  if (asked == pending_.end()) return;
  reply(asked->client, asked->address, event.refused ? "refused" : "ok", event.text);
  pending_.erase(asked);
}

void OscSurface::reply(const config::NetworkPlace& client, const std::string& address, const std::string& status,
                       const std::string& text) {
  const std::uint16_t port = settings_.reply_port != 0 ? settings_.reply_port : client.port;
  send({client.address, port}, osc_bytes({"/reply" + address, {status, text}}));
}

void OscSurface::send(const config::NetworkPlace& to, const std::vector<std::byte>& bytes) const {
  SocketAddress address = address_of(to);
  (void)::sendto(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL, address.get(), address.size);
}

std::vector<OscMessage> OscSurface::state_of(const DeskView& view) const {
  const ShowState& show = view.show;
  const auto& plays = desk_.orders().plays();
  const auto cue = [&](int which) {
    return which < 0 ? std::string() : plays[static_cast<std::size_t>(which)].cue.number.to_text();
  };
  const auto left_s = [&](Instant at) { return at == kNever ? -1.0 : std::max(0.0, to_seconds(at - show.at)); };
  std::string against;
  for (const std::string& one : view.against) against += (against.empty() ? "" : ", ") + one;
  return {{"/footlight/phase", {std::string(StateText::to_text(show.phase))}},
          {"/footlight/position", {to_seconds(show.position)}},
          {"/footlight/cue", {cue(show.active)}},
          {"/footlight/standby", {cue(show.standby)}},
          {"/footlight/goes-in", {left_s(show.goes_at)}},
          {"/footlight/ends-in", {left_s(show.ends_at)}},
          {"/footlight/tempo", {std::int32_t{show.percent}}},
          {"/footlight/against", {against}},
          {"/footlight/what", {text_.what_happens(show)}}};
}

void OscSurface::tell_lost(RunDesk& desk) {
  if (!guard_.any_lost() || clock_.now() - lost_told_ < kTellLost) return;
  lost_told_ = clock_.now();
  desk.tell({RunEvent::Kind::note, fmt::format("OSC: {} messages were lost: more than {} of a client in 20 ms",
                                               guard_.lost(), FloodGuard::kMost)});
}

}  // namespace footlight::app
