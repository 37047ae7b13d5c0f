// SPDX-License-Identifier: Apache-2.0
// What a technician asks of a CANopen node, by SDO. The show's own operations: canopen_driver.cpp.
#include <string>
#include <utility>

#include "core/check.hpp"
#include "drivers/devices/canopen/canopen_driver.hpp"

namespace footlight::drivers {
namespace {

using Kind = ServiceAnswer::Kind;
using canopen::ObjectPlace;
using canopen::SdoClient;

constexpr Duration kSdoTimeout = milliseconds(50);

// CiA 301; the first of them is mandatory, so whoever does not answer it is no CANopen node.
constexpr ObjectPlace kVendor{0x1018, 1};
constexpr ObjectPlace kProduct{0x1018, 2};
constexpr ObjectPlace kRevision{0x1018, 3};
constexpr ObjectPlace kSerialNumber{0x1018, 4};
constexpr ObjectPlace kDeviceName{0x1008, 0};
constexpr ObjectPlace kErrorRegister{0x1001, 0};
// Our own marker's (docs/wire-protocol.md).
constexpr ObjectPlace kBoots{0x2102, 4};
constexpr ObjectPlace kErrors{0x2102, 5};
constexpr ObjectPlace kChannels{0x2103, 0};
constexpr ObjectPlace kIdentify{0x2104, 0};
constexpr ObjectPlace kPlanCheck{0x2105, 1};
constexpr ObjectPlace kPatchCheck{0x2105, 2};

bool same(ObjectPlace a, ObjectPlace b) { return a.index == b.index && a.sub == b.sub; }

std::uint32_t number_of(const std::vector<std::uint8_t>& bytes) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < bytes.size() && i < 4; ++i) number |= std::uint32_t{bytes[i]} << (8U * i);
  return number;
}

std::string hexadecimal(std::uint32_t number) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string text = "0x";
  for (int shift = 28; shift >= 0; shift -= 4) text += kDigits[(number >> static_cast<unsigned>(shift)) & 0xFU];
  return text;
}

std::string printable(const std::vector<std::uint8_t>& bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) {
    if (byte == 0) break;
    text += byte >= 0x20 && byte < 0x7F ? static_cast<char>(byte) : '?';
  }
  return text;
}

/// What one object that was read adds to the answer.
void note(ServiceAnswer& answer, ObjectPlace place, const std::vector<std::uint8_t>& bytes) {
  Identity& identity = answer.identity;
  const std::uint32_t number = number_of(bytes);
  if (same(place, kVendor)) {
    identity.model = "CANopen vendor " + hexadecimal(number);
  } else if (same(place, kProduct)) {
    identity.model += " product " + hexadecimal(number);
  } else if (same(place, kRevision)) {
    identity.firmware = static_cast<int>(number & 0x7FFF'FFFFU);
  } else if (same(place, kSerialNumber)) {
    identity.unique_id = number;
  } else if (same(place, kDeviceName)) {
    identity.model = printable(bytes);
  } else if (same(place, kChannels)) {
    identity.channels = static_cast<int>(number);
  } else if (same(place, kErrorRegister)) {
    answer.health.push_back({"error register", static_cast<double>(number), ""});
  } else if (same(place, kErrors)) {
    answer.health.push_back({"errors", static_cast<double>(number), ""});
  } else if (same(place, kBoots)) {
    answer.health.push_back({"boots", static_cast<double>(number), ""});
  } else if (same(place, kPlanCheck)) {
    answer.kept.plan = number;
  } else if (same(place, kPatchCheck)) {
    answer.kept.patch = number;
  }
}

}  // namespace

std::string_view CanopenDriver::refusal(Task task) const {
  if (task == Task::set_address) return "the id of a CANopen node is set on the device";
  if (task == Task::clock) return "CANopen markers keep no show time";
  if (task == Task::patch && setup_) return "a module of outputs keeps nothing of a show";
  if (task == Task::identify && setup_) return "a module of outputs cannot show which one it is; its lamps can be lit";
  return {};
}

SendStatus CanopenDriver::probe(std::uint16_t address, unsigned /*round*/, Instant now) {
  return serve(Task::probe, address, {{kVendor}, {kProduct}, {kRevision}, {kSerialNumber}, {kDeviceName}, {kChannels}},
               now);
}

SendStatus CanopenDriver::identify(std::uint16_t address, bool on, Instant now) {
  return serve(Task::identify, address, {{kIdentify, {static_cast<std::uint8_t>(on ? 1 : 0)}}}, now);
}

SendStatus CanopenDriver::ask_health(std::uint16_t address, Instant now) {
  if (setup_) return serve(Task::health, address, {{kErrorRegister}}, now);
  return serve(Task::health, address, {{kErrorRegister}, {kErrors}, {kBoots}}, now);
}

SendStatus CanopenDriver::ask_patch(std::uint16_t address, std::optional<std::uint32_t> patch, Instant now) {
  std::vector<Transfer> transfers;
  if (patch) {
    Transfer& write = transfers.emplace_back(Transfer{kPatchCheck});
    for (unsigned i = 0; i < 4; ++i) write.written.push_back(static_cast<std::uint8_t>(*patch >> (8U * i)));
  }
  transfers.push_back({kPlanCheck});
  transfers.push_back({kPatchCheck});
  return serve(Task::patch, address, std::move(transfers), now);
}

SendStatus CanopenDriver::tell_plan(std::uint32_t check, Instant /*now*/) {
  if (down()) return SendStatus::down;
  if (!ready()) return SendStatus::busy;
  return hand_over(canopen::plan_check(check));
}

SendStatus CanopenDriver::ask_kept(const NodeAddress& node, Instant now) {
  const SendStatus status = serve(Task::patch, node.address, {{kPlanCheck}, {kPatchCheck}}, now);
  if (status == SendStatus::accepted && service_) service_->of_show = node.node;
  return status;
}

Duration CanopenDriver::kept_time() const { return 4 * frame_time(); }

SendStatus CanopenDriver::serve(Task task, std::uint16_t address, std::vector<Transfer> transfers, Instant now) {
  FL_CHECK(address >= 1 && address <= canopen::kLastNode);
  if (down()) return SendStatus::down;
  if (!ready() || service_ || (setup_ && setup_->under_way())) return SendStatus::busy;
  Service service;
  service.answer = ServiceAnswer{task, Kind::silent, address, 0, {}, {}};
  service.transfers = std::move(transfers);
  ask_next_object(service, now);
  service_ = std::move(service);
  pump();
  return SendStatus::accepted;
}

void CanopenDriver::ask_next_object(Service& service, Instant now) {
  const auto& [place, written] = service.transfers.at(service.next);
  const auto node = static_cast<std::uint8_t>(service.answer.address);
  outbox_.push_back(written.empty() ? sdo_.read(node, place) : sdo_.write(node, place, written));
  service.deadline = now + kSdoTimeout;
}

void CanopenDriver::hear_sdo(const CanFrame& frame, Instant now) {
  if (!service_) return;
  if (auto request = sdo_.take(frame)) {
    outbox_.push_back(*request);
    service_->deadline = now + kSdoTimeout;
  }
}

/// Goes on to the next object when one is there, and tells the answer when none is left.
void CanopenDriver::serve_on(Instant now, EventSink& events) {
  if (!service_) return;
  Service& service = *service_;
  ServiceAnswer& answer = service.answer;
  const auto& [place, written] = service.transfers.at(service.next);
  const bool silent = sdo_.state() == SdoClient::State::waiting && now >= service.deadline;
  if (sdo_.state() == SdoClient::State::waiting && !silent && !down()) return;
  if (sdo_.state() == SdoClient::State::done) {
    answer.kind = answer.task == Task::probe ? Kind::found : Kind::done;
    if (written.empty()) note(answer, place, sdo_.data());
  } else if (sdo_.state() == SdoClient::State::aborted && answer.kind == Kind::silent) {
    // A node that says no is there; only what was asked of it alone is refused by that.
    answer.kind = answer.task == Task::probe ? Kind::found : Kind::refused;
    answer.detail = static_cast<int>(sdo_.abort_code());
  }
  if (silent) outbox_.push_back(sdo_.give_up());
  const bool refused = answer.task == Task::patch && answer.kind == Kind::refused;
  const bool over = silent || down() || refused || ++service.next == service.transfers.size();
  if (!over) {
    ask_next_object(service, now);
    return;
  }
  if (silent) answer.kind = answer.task == Task::patch ? Kind::silent : answer.kind;
  tell(service, events);
  service_.reset();
}

void CanopenDriver::tell(const Service& service, EventSink& events) {
  if (!service.of_show) return events.on_answer(service.answer);
  if (service.answer.kind != Kind::done) return;
  DeviceEvent event{DeviceEvent::Kind::keeps, *service.of_show};
  event.kept = service.answer.kept;
  events.on_event(event);
}

}  // namespace footlight::drivers
