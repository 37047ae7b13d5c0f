// SPDX-License-Identifier: Apache-2.0
#include "sim/dmx_bus.hpp"

#include <algorithm>
#include <utility>

#include "core/check.hpp"

namespace footlight::sim {
namespace {

constexpr int kBitsPerCharacter = 10;
constexpr Duration kBreakAndMark = microseconds(92 + 12);  // ANSI E1.11, table 6, the least
constexpr Duration kSlotTime = microseconds(44);

}  // namespace

DmxBus::DmxBus(const Bus& bus, const Surroundings& surroundings)
    : SimulatedBus(bus, surroundings), sent_until_(around_.world.now()), packet_until_(around_.world.now()) {
  FL_CHECK(bus.fixture.has_value());
}

std::size_t DmxBus::add(std::unique_ptr<SimulatedNode> node) {
  heard_.emplace_back().fill(0);
  nodes_.push_back(std::move(node));
  return nodes_.size() - 1;
}

Duration DmxBus::wire_time(std::size_t bytes) const {
  return bit_time(static_cast<std::int64_t>(bytes) * kBitsPerCharacter, bus_.bits_per_second);
}

drivers::SendStatus DmxBus::write(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return drivers::SendStatus::accepted;
  const Instant from = std::max(around_.world.now(), sent_until_);
  if (from - around_.world.now() + wire_time(bytes.size()) > wire_time(kBuffer)) return drivers::SendStatus::busy;
  sent_until_ = from + wire_time(bytes.size());
  on_the_way_.emplace_back(bytes.begin(), bytes.end());
  around_.world.schedule(sent_until_, *this, token(kWidgetHears, 0, 0));
  return drivers::SendStatus::accepted;
}

std::size_t DmxBus::read(std::span<std::uint8_t> buffer) {
  const std::size_t count = std::min(buffer.size(), answers_.size());
  const auto end = answers_.begin() + static_cast<std::ptrdiff_t>(count);
  std::copy(answers_.begin(), end, buffer.begin());
  answers_.erase(answers_.begin(), end);
  return count;
}

void DmxBus::act(std::uint64_t token_of_event) {
  if (kind_of(token_of_event) == kWidgetHears) {
    if (around_.trace.on()) {
      around_.trace.line(around_.world.now(), bus_.name, '>', to_hex(on_the_way_.front()), "");
    }
    const std::uint64_t before = widget_.packets();
    const auto answer = widget_.receive(on_the_way_.front());
    on_the_way_.pop_front();
    answers_.insert(answers_.end(), answer.begin(), answer.end());
    if (widget_.packets() == before) return;
    const Duration time = kBreakAndMark + static_cast<Duration::rep>(widget_.sent() + 1) * kSlotTime;
    packet_until_ = std::max(around_.world.now(), packet_until_) + time;
    packets_.push_back(widget_.slots());
    ++use_.frames;
    use_.busy += time;
    around_.world.schedule(packet_until_, *this, token(kPacketEnds, 0, 0));
    return;
  }
  line_ = packets_.front();
  packets_.pop_front();
  std::string note;
  bool missed = false;
  for (std::size_t slot = 0; slot < nodes_.size(); ++slot) {
    if (misses(nodes_[slot]->name(), note)) {
      missed = true;
    } else {
      heard_[slot] = line_;
    }
  }
  if (!missed || !packets_.empty()) return;
  // The widget says it again.
  const Duration time = kBreakAndMark + static_cast<Duration::rep>(widget_.sent() + 1) * kSlotTime;
  packets_.push_back(widget_.slots());
  packet_until_ = around_.world.now() + time;
  around_.world.schedule(packet_until_, *this, token(kPacketEnds, 0, 0));
}

std::vector<std::uint8_t> DmxBus::levels(std::size_t slot, int channel) const {
  const auto footprint = bus_.fixture->slots.size();
  std::vector<std::uint8_t> out(footprint, 0);
  if (!nodes_[slot]->powered()) return out;
  const std::size_t first = nodes_[slot]->address() - 1U + static_cast<std::size_t>(channel) * footprint;
  for (std::size_t i = 0; i < footprint && first + i < UsbProWidget::kSlots; ++i) out[i] = heard_[slot][first + i];
  return out;
}

Colour DmxBus::colour(std::size_t slot, int channel) const {
  const auto levels = this->levels(slot, channel);
  const auto& kinds = bus_.fixture->slots;
  int dimmer = 255;
  int red = 0;
  int green = 0;
  int blue = 0;
  int white = 0;
  bool coloured = false;
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (kinds[i] == DmxSlot::dimmer) dimmer = levels[i];
    if (kinds[i] == DmxSlot::red) red = levels[i];
    if (kinds[i] == DmxSlot::green) green = levels[i];
    if (kinds[i] == DmxSlot::blue) blue = levels[i];
    if (kinds[i] == DmxSlot::white) white = levels[i];
    coloured = coloured || (kinds[i] != DmxSlot::dimmer && kinds[i] != DmxSlot::zero && kinds[i] != DmxSlot::full);
  }
  if (!coloured) white = 255;  // a lamp of one colour behind its dimmer
  const auto seen = [&](int level) { return static_cast<std::uint8_t>(std::min(255, level + white) * dimmer / 255); };
  return {seen(red), seen(green), seen(blue)};
}

}  // namespace footlight::sim
