// SPDX-License-Identifier: Apache-2.0
#include "sim/endpoints/serial_endpoints.hpp"

#include <span>

namespace footlight::sim {
namespace {

constexpr Duration kWhenBusy = milliseconds(1);

}  // namespace

void SerialEndpoint::add_handles(std::vector<pollfd>& files) const {
  // While the bus's buffer is full, the writer has to wait; hanging up is seen all the same.
  files.push_back({terminal_.handle(), static_cast<short>(waiting_size_ == 0 ? POLLIN : 0), 0});
}

Instant SerialEndpoint::step(Instant now) {
  while (true) {
    if (waiting_size_ == 0) waiting_size_ = terminal_.read(waiting_);
    if (waiting_size_ == 0) break;
    used_ = true;
    if (bus_.write(std::span(waiting_).first(waiting_size_)) != drivers::SendStatus::accepted) break;
    waiting_size_ = 0;
  }
  std::array<std::uint8_t, kPiece> said{};
  while (const std::size_t count = bus_.read(said)) terminal_.write(std::span(said).first(count));
  return waiting_size_ == 0 ? kNever : now + kWhenBusy;
}

void RtuEndpoint::add_handles(std::vector<pollfd>& files) const { files.push_back({terminal_.handle(), POLLIN, 0}); }

Instant RtuEndpoint::step(Instant now) {
  std::array<std::uint8_t, 512> buffer{};
  while (const std::size_t count = terminal_.read(buffer)) {
    used_ = true;
    framing_.take(std::span(buffer).first(count), now);
  }
  while (const auto frame = framing_.next(now)) bus_.say(0, *frame);
  int client = 0;
  std::vector<std::uint8_t> said;
  while (bus_.hear(client, said)) terminal_.write(said);
  return framing_.silence_at();
}

}  // namespace footlight::sim
