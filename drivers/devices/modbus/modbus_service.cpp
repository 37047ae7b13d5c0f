// SPDX-License-Identifier: Apache-2.0
// What a technician asks of a Modbus device. The show's own operations: modbus_driver.cpp.
#include <utility>

#include "core/check.hpp"
#include "drivers/devices/modbus/modbus_driver.hpp"

namespace footlight::drivers {
namespace {

using Kind = ServiceAnswer::Kind;

std::uint16_t low_word(std::uint32_t value) { return static_cast<std::uint16_t>(value & 0xFFFFU); }
std::uint16_t high_word(std::uint32_t value) { return static_cast<std::uint16_t>(value >> 16U); }

std::string text_of(const std::vector<std::uint16_t>& registers) {
  std::string text;
  for (const std::uint16_t word : registers) {
    for (const int byte : {word >> 8, word & 0xFF}) {
      if (byte == 0) return text;
      text += byte >= 0x20 && byte < 0x7F ? static_cast<char>(byte) : '?';
    }
  }
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

std::string numbers_of(const std::vector<std::uint16_t>& registers) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string text;
  for (const std::uint16_t word : registers) {
    if (!text.empty()) text += ' ';
    for (int shift = 12; shift >= 0; shift -= 4) text += kDigits[(word >> static_cast<unsigned>(shift)) & 0xFU];
  }
  return text;
}

ModbusRequest reading(std::uint8_t unit, int first, int count) {
  return {unit, modbus::kReadRegisters, static_cast<std::uint16_t>(first), static_cast<std::uint16_t>(count), {}};
}

}  // namespace

std::string_view ModbusDriver::refusal(Task task) const {
  switch (task) {
    case Task::probe:
      return {};
    case Task::identify:
      if (profile_.identify_register || !profile_.latch_register) return {};
      return "the device's profile has no identify_register";
    case Task::set_address:
      if (profile_.address_register || profile_.readdress_register) return {};
      return "the device's profile has neither address_register nor readdress_register: its address is set by hand";
    case Task::health:
      return profile_.health.empty() ? "the device's profile has no health registers" : std::string_view{};
    case Task::clock:
      return "Modbus devices keep no show time";
    case Task::patch:
      return modbus::kept_register(profile_) ? std::string_view{} : "only our own marker keeps plan and patch";
  }
  return {};
}

SendStatus ModbusDriver::serve(Task task, std::uint16_t address, modbus::Requests requests, Instant now) {
  std::vector<Job> jobs;
  append(jobs, Purpose::service, NodeIndex{}, 0, std::move(requests));
  const SendStatus status = run(std::move(jobs), now);
  if (status == SendStatus::accepted) service_ = ServiceAnswer{task, Kind::done, address, 0, {}, {}};
  return status;
}

/// Round 0 reads the least that shows that somebody is there; later rounds ask who.
SendStatus ModbusDriver::probe(std::uint16_t address, unsigned round, Instant now) {
  const auto unit = static_cast<std::uint8_t>(address);
  modbus::Requests requests;
  if (round > 0 && profile_.unique_id_register) requests.push_back(reading(unit, *profile_.unique_id_register, 2));
  if (round > 0 && profile_.identity_register) {
    requests.push_back(reading(unit, *profile_.identity_register, profile_.identity_registers));
  }
  if (requests.empty()) {
    // Whoever answers with an exception is there, too: what is read matters little.
    requests.push_back(profile_.status_register  ? modbus::status_request(profile_, unit)
                       : profile_.readable_looks ? modbus::looks_request(profile_, unit, 1)
                                                 : reading(unit, profile_.look_register, 1));
  }
  return serve(Task::probe, address, std::move(requests), now);
}

SendStatus ModbusDriver::identify(std::uint16_t address, bool on, Instant now) {
  FL_CHECK(refusal(Task::identify).empty());
  const auto unit = static_cast<std::uint8_t>(address);
  if (profile_.identify_register) {
    return serve(Task::identify, address,
                 {{unit,
                   modbus::kWriteRegister,
                   static_cast<std::uint16_t>(*profile_.identify_register),
                   1,
                   {static_cast<std::uint16_t>(on ? 1 : 0)}}},
                 now);
  }
  // Its lamps say which one it is: they act at once.
  int channels = profile_.channels;
  for (const NodeAddress& node : nodes_) {
    if (node.address == address) channels = node.channels;
  }
  const Look white{{255, 255, 255}, Effect::blink, 255};
  const LookIndex lit = profile_.shows_own_numbers() ? modbus::value_of(profile_, 1, white) : LookIndex{1};
  const LookIndex dark = modbus::value_of(profile_, kDark, looks_[kDark]);
  const std::vector<LookIndex> values(static_cast<std::size_t>(channels), on ? lit : dark);
  return serve(Task::identify, address, modbus::preload(profile_, unit, plan_byte_, 1, values), now);
}

SendStatus ModbusDriver::set_address(std::uint16_t from, std::optional<std::uint32_t> unique_id, std::uint16_t to,
                                     Instant now) {
  FL_CHECK(refusal(Task::set_address).empty() && to >= 1 && to <= 247);
  const auto unit = static_cast<std::uint8_t>(from);
  if (profile_.readdress_register && unique_id) {
    const auto first = profile_.low_word_first ? low_word(*unique_id) : high_word(*unique_id);
    const auto second = profile_.low_word_first ? high_word(*unique_id) : low_word(*unique_id);
    return serve(Task::set_address, from,
                 {{unit,
                   modbus::kWriteRegisters,
                   static_cast<std::uint16_t>(*profile_.readdress_register),
                   4,
                   {first, second, to, static_cast<std::uint16_t>(to ^ 0x5A5AU)}}},
                 now);
  }
  FL_CHECK(profile_.address_register.has_value());
  return serve(Task::set_address, from,
               {{unit, modbus::kWriteRegister, static_cast<std::uint16_t>(*profile_.address_register), 1, {to}}}, now);
}

SendStatus ModbusDriver::ask_health(std::uint16_t address, Instant now) {
  FL_CHECK(refusal(Task::health).empty());
  modbus::Requests requests;
  for (const HealthRegister& entry : profile_.health) {
    requests.push_back(reading(static_cast<std::uint8_t>(address), entry.number, 1));
  }
  return serve(Task::health, address, std::move(requests), now);
}

SendStatus ModbusDriver::ask_patch(std::uint16_t address, std::optional<std::uint32_t> patch, Instant now) {
  FL_CHECK(refusal(Task::patch).empty());
  const auto unit = static_cast<std::uint8_t>(address);
  modbus::Requests requests;
  if (patch) requests = modbus::patch_check(profile_, unit, *patch);
  requests.push_back(modbus::kept_request(profile_, unit));
  return serve(Task::patch, address, std::move(requests), now);
}

SendStatus ModbusDriver::tell_plan(std::uint32_t check, Instant now) {
  return run(to_all(Purpose::look, 0, [&](std::uint8_t unit) { return modbus::plan_check(profile_, unit, check); }),
             now);
}

SendStatus ModbusDriver::ask_kept(const NodeAddress& node, Instant now) {
  return run({{Purpose::kept, node.node, 0, modbus::kept_request(profile_, node.unit())}}, now);
}

Duration ModbusDriver::kept_time() const {
  return modbus::kept_register(profile_) ? port_.wire_time(modbus::kept_request(profile_, 1)) : Duration{};
}

/// What it keeps is nothing of what it shows: no answer is no miss, though it may still come.
void ModbusDriver::take_kept(const Job& job, const ModbusReply& reply, bool same, Instant now, EventSink& events) {
  if (reply.outcome == ModbusReply::Outcome::exception && same) return;
  const auto kept = modbus::decode_kept(profile_, reply.values);
  if (reply.outcome != ModbusReply::Outcome::ok || !same || !kept) {
    known_[job.node].owes = true;
    begin_quiet(now);
    return;
  }
  DeviceEvent event{DeviceEvent::Kind::keeps, job.node};
  event.kept = *kept;
  events.on_event(event);
}

void ModbusDriver::finish_service(const Job& job, const ModbusReply& reply, EventSink& events) {
  FL_CHECK(service_.has_value());
  const bool probing = service_->task == Task::probe;
  if (probing) service_->kind = Kind::found;
  if (reply.outcome == ModbusReply::Outcome::exception) {
    if (!probing) service_->kind = Kind::refused;
    service_->detail = reply.exception_code;
  } else if (reply.outcome != ModbusReply::Outcome::ok && probing && service_->identity.unique_id) {
    drop_rest_of(job);  // it has said who it is
    events.on_answer(*std::exchange(service_, std::nullopt));
    return;
  } else if (reply.outcome != ModbusReply::Outcome::ok) {
    service_->kind = reply.outcome == ModbusReply::Outcome::timeout ? Kind::silent : Kind::garbled;
  } else {
    take_service(job, reply);
  }
  const bool goes_on = service_->kind == Kind::found || service_->kind == Kind::done;
  if (goes_on && !job.last) return;
  drop_rest_of(job);
  events.on_answer(*std::exchange(service_, std::nullopt));
}

void ModbusDriver::take_service(const Job& job, const ModbusReply& reply) {
  const int first = job.request.first_register;
  if (service_->task == Task::probe && profile_.unique_id_register == first && reply.values.size() == 2) {
    const std::uint32_t high = reply.values[profile_.low_word_first ? 1 : 0];
    const std::uint32_t low = reply.values[profile_.low_word_first ? 0 : 1];
    service_->identity.unique_id = (high << 16U) | low;
  } else if (service_->task == Task::probe && profile_.identity_register == first && job.request.count > 0) {
    service_->identity.model = profile_.identity_is_text ? text_of(reply.values) : numbers_of(reply.values);
  } else if (service_->task == Task::patch && job.request.function == modbus::kReadRegisters) {
    if (const auto kept = modbus::decode_kept(profile_, reply.values)) {
      service_->kept = *kept;
    } else {
      service_->kind = Kind::garbled;
    }
  } else if (service_->task == Task::health && reply.values.size() == 1) {
    for (const HealthRegister& entry : profile_.health) {
      if (entry.number != first) continue;
      const auto raw = reply.values[0];
      if (entry.name == "battery" && raw == 0xFFFF) continue;  // it has none
      const double value =
          entry.has_sign ? static_cast<double>(static_cast<std::int16_t>(raw)) : static_cast<double>(raw);
      service_->health.push_back({entry.name, value * entry.scale, entry.unit});
    }
  }
}

}  // namespace footlight::drivers
