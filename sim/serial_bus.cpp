// SPDX-License-Identifier: Apache-2.0
#include "sim/serial_bus.hpp"

#include <algorithm>
#include <utility>

namespace footlight::sim {
namespace {

constexpr Duration kShortestTurnaround = microseconds(200);
constexpr Duration kLongestTurnaround = microseconds(2000);
constexpr std::size_t kReceiveBuffer = 65'536;

/// Bytes up to and including the delimiter that ends the first frame; all of them when none ends.
std::size_t first_frame(std::span<const std::uint8_t> bytes) {
  bool inside = false;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (bytes[i] != 0) {
      inside = true;
    } else if (inside) {
      return i + 1;
    }
  }
  return bytes.size();
}

}  // namespace

SerialBus::SerialBus(const Bus& bus, const Surroundings& surroundings)
    : SimulatedBus(bus, surroundings),
      line_(bus_, bus.bits_per_character(), Duration{}, around_, use_, *this),
      sent_until_(around_.world.now()) {}

std::size_t SerialBus::add(std::unique_ptr<SimulatedNode> node) {
  markers_.emplace_back(static_cast<std::uint8_t>(node->address()), node->model(), node->unique_id());
  answers_.emplace_back();
  missed_.push_back(false);
  nodes_.push_back(std::move(node));
  return nodes_.size() - 1;
}

void SerialBus::power_off(std::size_t slot) {
  nodes_[slot]->power_off();
  ++answers_[slot].generation;
  line_.cut(static_cast<int>(slot));
}

void SerialBus::power_on(std::size_t slot) {
  nodes_[slot]->power_on();
  markers_[slot].power_on();
}

drivers::SendStatus SerialBus::write(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return drivers::SendStatus::accepted;
  const Instant now = around_.world.now();
  const Instant free_at = std::max(now, sent_until_);
  if (free_at - now + line_.time_of(bytes.size()) > line_.time_of(kBuffer)) return drivers::SendStatus::busy;
  sent_until_ = free_at;
  while (!bytes.empty()) {
    const auto frame = bytes.first(first_frame(bytes));
    sent_until_ = line_.say(kController, {frame.begin(), frame.end()}, sent_until_);
    bytes = bytes.subspan(frame.size());
  }
  return drivers::SendStatus::accepted;
}

std::size_t SerialBus::read(std::span<std::uint8_t> buffer) {
  const std::size_t count = std::min(buffer.size(), received_.size());
  const auto end = received_.begin() + static_cast<std::ptrdiff_t>(count);
  std::copy(received_.begin(), end, buffer.begin());
  received_.erase(received_.begin(), end);
  return count;
}

void SerialBus::draw_losses(int speaker, std::string& note) {
  if (speaker != kController) {
    controller_missed_ = misses("controller", note);
    return;
  }
  for (std::size_t slot = 0; slot < nodes_.size(); ++slot) {
    missed_[slot] = nodes_[slot]->powered() && misses(nodes_[slot]->name(), note);
  }
}

void SerialBus::heard(int speaker, std::span<const std::uint8_t> bytes, bool) {
  if (speaker != kController && !controller_missed_ && received_.size() + bytes.size() <= kReceiveBuffer) {
    received_.insert(received_.end(), bytes.begin(), bytes.end());
  }
  for (std::size_t slot = 0; slot < nodes_.size(); ++slot) {
    const bool misses_it = speaker == kController ? missed_[slot] : static_cast<int>(slot) == speaker;
    if (!misses_it && nodes_[slot]->powered()) node_hears(slot, bytes);
  }
}

void SerialBus::node_hears(std::size_t slot, std::span<const std::uint8_t> bytes) {
  auto answer = markers_[slot].receive(bytes, around_.world.now());
  nodes_[slot]->after_receiving();
  if (answer.empty()) return;
  const Duration turnaround =
      kShortestTurnaround + around_.timing.up_to(kLongestTurnaround - kShortestTurnaround) + around_.faults.lateness();
  const Duration slot_time = line_.time_of(SerialMarker::kSlotCharacters) + kLongestTurnaround;
  const Duration later = markers_[slot].answer_slot() * slot_time;
  answers_[slot].bytes = std::move(answer);
  around_.world.schedule(around_.world.now() + later + turnaround, *this, token(0, slot, ++answers_[slot].generation));
}

void SerialBus::act(std::uint64_t token_of_event) {
  const std::size_t slot = slot_of(token_of_event);
  if (answers_[slot].generation != generation_of(token_of_event)) return;
  line_.say(static_cast<int>(slot), std::exchange(answers_[slot].bytes, {}), around_.world.now());
}

}  // namespace footlight::sim
