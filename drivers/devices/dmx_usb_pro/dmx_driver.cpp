// SPDX-License-Identifier: Apache-2.0
#include "drivers/devices/dmx_usb_pro/dmx_driver.hpp"

#include <algorithm>
#include <utility>

#include "core/check.hpp"

namespace footlight::drivers {
namespace {

constexpr Duration kPacketPeriod = milliseconds(25);  // while a lamp has an effect
constexpr Duration kRefresh = milliseconds(1000);     // the widget may have been switched off and on
constexpr Duration kIdentify = milliseconds(10'000);
constexpr std::size_t kMessage = 6;  // bytes around the slots

const Look kIdentifyLook{{255, 255, 255}, Effect::blink, 255};

}  // namespace

DmxDriver::DmxDriver(ByteStream& port, DmxFixture fixture, const std::vector<NodeAddress>& nodes)
    : port_(port), fixture_(std::move(fixture)) {
  FL_CHECK(!fixture_.slots.empty());
  const auto footprint = static_cast<int>(fixture_.slots.size());
  for (const NodeAddress& node : nodes) {
    first_lamp_[node.node] = lamps_.size();
    for (int c = 0; c < node.channels; ++c) lamps_.push_back({node.address + c * footprint});
    slots_ = std::max(slots_, node.address + node.channels * footprint - 1);
  }
  FL_CHECK(slots_ <= dmx::kSlots);
  looks_.fill(Look{{255, 255, 255}, Effect::steady, 255});
  looks_[kDark] = Look{{0, 0, 0}, Effect::steady, 0};
  looks_[kNoGuidance] = no_guidance_look();
}

Capabilities DmxDriver::capabilities() const {
  Capabilities can;
  can.readback = false;
  can.proves_looks = false;
  can.lease = false;
  return can;
}

std::string DmxDriver::assumption() const {
  return "DMX goes one way and has no check sum: what was sent is taken for shown; lamps keep their levels when the "
         "controller is silent";
}

Duration DmxDriver::latch_time() const {
  return port_.wire_time(kMessage + static_cast<std::size_t>(slots_)) + dmx::packet_time(slots_);
}

SendStatus DmxDriver::start(Instant now) { return send(now); }

SendStatus DmxDriver::preload(const NodeAddress& node, Sequence sequence, std::span<const LookIndex> looks,
                              Instant /*now*/) {
  FL_CHECK(sequence >= 1 && sequence <= kLastSequence);
  FL_CHECK(looks.size() == node.channels && first_lamp_.contains(node.node));
  if (down_) return SendStatus::down;
  if (!due_.empty()) return SendStatus::busy;
  kept_[node.node] = Kept{node, sequence, {looks.begin(), looks.end()}};
  due_.push_back({DeviceEvent::Kind::preloaded, node.node, sequence});
  return SendStatus::accepted;
}

SendStatus DmxDriver::latch(Sequence sequence, Instant now) {
  FL_CHECK(sequence >= 1 && sequence <= kLastSequence);
  if (line_taken_) return SendStatus::busy;
  std::vector<std::pair<std::size_t, LookIndex>> before;
  for (const auto& [node, kept] : kept_) {
    if (kept.sequence != sequence) continue;
    const std::size_t first = first_lamp_.at(node);
    for (std::size_t c = 0; c < kept.looks.size(); ++c) {
      before.emplace_back(first + c, std::exchange(lamps_[first + c].look, kept.looks[c]));
    }
  }
  const SendStatus status = send(now);
  if (status == SendStatus::accepted) {
    std::erase_if(kept_, [&](const auto& entry) { return entry.second.sequence == sequence; });
  } else {
    for (const auto& [lamp, look] : before) lamps_[lamp].look = look;
  }
  return status;
}

SendStatus DmxDriver::heartbeat(Duration /*show_time*/, Instant now) {
  // Nobody has a lease; a packet tells whether the widget is still there.
  return alive_ && !down_ && now - sent_at_ < kRefresh ? SendStatus::accepted : send(now);
}

SendStatus DmxDriver::ask(const NodeAddress& /*node*/, Instant /*now*/) { return SendStatus::accepted; }

SendStatus DmxDriver::upload_look(LookIndex index, const Look& look, Instant /*now*/) {
  if (index == kDark || index == kNoGuidance) return SendStatus::accepted;
  changed_ = changed_ || looks_[index] != look;
  looks_[index] = look;
  return SendStatus::accepted;
}

std::string_view DmxDriver::refusal(Task task) const {
  switch (task) {
    case Task::probe:
      return "DMX goes one way, nobody answers (identify lights a lamp)";
    case Task::identify:
      return {};
    case Task::set_address:
      return "DMX goes one way: addresses are set at the lamps";
    case Task::health:
    case Task::patch:
      return "a DMX lamp keeps nothing of a show";
    case Task::clock:
      return "DMX goes one way: lamps cannot tell";
  }
  return {};
}

SendStatus DmxDriver::identify(std::uint16_t address, bool on, Instant now) {
  const auto footprint = static_cast<int>(fixture_.slots.size());
  if (address < 1 || address + footprint - 1 > dmx::kSlots) return SendStatus::accepted;
  const Instant until = on ? now + kIdentify : Instant{};
  bool known = false;
  for (Lamp& lamp : lamps_) {
    if (lamp.slot != address) continue;
    lamp.identifies_until = until;
    known = true;
  }
  if (!known) {
    lamps_.push_back({address, kDark, until});
    slots_ = std::max(slots_, address + footprint - 1);
  }
  const SendStatus status = send(now);
  if (status == SendStatus::accepted) {
    answers_.push_back({Task::identify, ServiceAnswer::Kind::done, address, 0, {}, {}});
  }
  return status;
}

std::vector<std::uint8_t> DmxDriver::packet(Instant now) const {
  std::vector<std::uint8_t> slots(static_cast<std::size_t>(slots_), 0);
  for (const Lamp& lamp : lamps_) {
    const Look& look = now < lamp.identifies_until ? kIdentifyLook : looks_[lamp.look];
    const auto levels = dmx::levels(fixture_, look, dmx::share_of(look.effect, now));
    std::ranges::copy(levels, slots.begin() + (lamp.slot - 1));
  }
  return slots;
}

bool DmxDriver::moves(Instant now) const {
  return std::ranges::any_of(lamps_, [&](const Lamp& lamp) {
    return now < lamp.identifies_until ||
           (looks_[lamp.look].effect != Effect::steady && looks_[lamp.look].brightness > 0);
  });
}

SendStatus DmxDriver::send(Instant now) {
  if (line_taken_) return SendStatus::busy;
  const std::vector<std::uint8_t> message = dmx::output(packet(now));
  const SendStatus status = port_.write(message);
  if (status != SendStatus::busy) down_ = status == SendStatus::down;
  if (status != SendStatus::accepted) return status;
  alive_ = true;
  changed_ = false;
  sent_at_ = now;
  line_free_ = now + port_.wire_time(message.size());
  line_taken_ = true;
  return status;
}

Instant DmxDriver::step(Instant now, EventSink& events) {
  std::array<std::uint8_t, 256> unread{};  // the widget answers nothing that we ask; what it says is left alone
  for (int reads = 0; reads < 16 && port_.read(unread) > 0; ++reads) {
  }
  for (const DeviceEvent& event : std::exchange(due_, {})) events.on_event(event);
  for (const ServiceAnswer& answer : std::exchange(answers_, {})) events.on_answer(answer);
  line_taken_ = now < line_free_;
  const Duration period = moves(now) ? kPacketPeriod : kRefresh;
  if (alive_ && !line_taken_ && (changed_ || now - sent_at_ >= period)) (void)send(now);
  if (down_ != down_told_) {
    down_told_ = down_;
    events.on_event({down_ ? DeviceEvent::Kind::bus_down : DeviceEvent::Kind::bus_up, NodeIndex{}});
  }
  if (!alive_) return kNever;
  if (down_) return now + kRefresh;
  return std::max(line_free_, sent_at_ + (moves(now) ? kPacketPeriod : kRefresh));
}

}  // namespace footlight::drivers
