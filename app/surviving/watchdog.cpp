// SPDX-License-Identifier: Apache-2.0
#include "app/surviving/watchdog.hpp"

#include <charconv>
#include <cstddef>
#include <cstring>

#include <sys/socket.h>
#include <sys/un.h>

#include "app/environment.hpp"

namespace footlight::app {

Notifier::Notifier() : address_(environment("NOTIFY_SOCKET")) {
  const bool path = address_.starts_with('/') || address_.starts_with('@');
  if (!path || address_.size() >= sizeof(sockaddr_un::sun_path)) return;
  socket_ = FileDescriptor(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const std::string text = environment("WATCHDOG_USEC");
  long long us = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), us);
  if (error == std::errc{} && end == text.data() + text.size() && us > 0) period_ = microseconds(us / 2);
}

void Notifier::say(std::string_view message) const noexcept {
  if (!wanted()) return;
  sockaddr_un to{};
  to.sun_family = AF_UNIX;
  std::memcpy(to.sun_path, address_.data(), address_.size());
  if (address_[0] == '@') to.sun_path[0] = '\0';  // a name without a file
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + address_.size());
  (void)::sendto(socket_.get(), message.data(), message.size(), MSG_NOSIGNAL | MSG_DONTWAIT,
                 reinterpret_cast<const sockaddr*>(&to), length);
}

void Watchdog::beat(const ShowState& state, bool roll_called) {
  if (!notifier_.wanted()) return;
  if (roll_called && !ready_told_) {
    ready_told_ = true;
    notifier_.say("READY=1");
  }
  const Instant at = state.at;
  // Half of the period, and half of that for the time between two looks.
  if (!notifier_.period() || (lived_at_ && at - *lived_at_ < *notifier_.period() / 2)) return;
  lived_at_ = at;
  notifier_.say("WATCHDOG=1");
}

}  // namespace footlight::app
