// SPDX-License-Identifier: Apache-2.0
#include "drivers/devices/canopen/module_setup.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "core/check.hpp"

namespace footlight::drivers::canopen {
namespace {

constexpr Duration kTimeout = milliseconds(50);
constexpr Duration kAgain = milliseconds(1000);

constexpr ObjectPlace kDeviceType{0x1000, 0};
constexpr std::uint32_t kDigitalOutputs = 0x0002'0191;  // CiA 401 in the low word, digital outputs in bit 17
constexpr std::uint32_t kDeviceTypeBits = 0x0002'FFFF;
constexpr std::uint32_t kInvalid = 0x8000'0000;       // bit 31 of a PDO's COB-ID
constexpr std::uint32_t kWithoutBit30 = 0xBFFF'FFFF;  // bit 30 of an RPDO's COB-ID is nobody's
constexpr std::uint32_t kSynchronous = 1;
constexpr std::uint32_t kController = 127;

constexpr std::uint16_t kRpdoParameters = 0x1400;
constexpr std::uint16_t kRpdoMapping = 0x1600;
constexpr std::uint16_t kOutputs = 0x6200;
constexpr std::uint16_t kErrorMode = 0x6206;
constexpr std::uint16_t kErrorValue = 0x6207;

ObjectPlace place_of(std::uint16_t index, int sub) { return {index, static_cast<std::uint8_t>(sub)}; }

std::uint32_t in_ms(Duration duration) { return static_cast<std::uint32_t>(duration / milliseconds(1)); }

std::string hexadecimal(std::uint32_t number, int digits) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string text = "0x";
  for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4) {
    text += kDigits[(number >> static_cast<unsigned>(shift)) & 0xFU];
  }
  return text;
}

std::uint32_t number_of(std::span<const std::uint8_t> bytes) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < bytes.size() && i < 4; ++i) number |= std::uint32_t{bytes[i]} << (8U * i);
  return number;
}

}  // namespace

std::vector<SetupStep> setup_steps(const OutputModule& module, std::uint8_t node) {
  std::vector<SetupStep> steps;
  std::vector<SetupStep> checks;
  const auto check = [&](ObjectPlace place, std::uint32_t value, std::uint32_t mask = 0xFFFF'FFFF) {
    steps.push_back({place, value, 0, mask});
  };
  /// @param stays false: an intermediate value
  const auto write = [&](ObjectPlace place, std::uint32_t value, int bytes, bool stays = true) {
    steps.push_back({place, value, bytes});
    if (stays) checks.push_back({place, value, 0});
  };
  check(kDeviceType, kDigitalOutputs, kDeviceTypeBits);
  if (module.vendor) check(place_of(0x1018, 1), *module.vendor);
  if (module.product) check(place_of(0x1018, 2), *module.product);

  const std::uint32_t identifier = 0x200U + node;
  write(place_of(kRpdoParameters, 1), kInvalid | identifier, 4, false);
  write(place_of(kRpdoMapping, 0), 0, 1, false);
  for (int byte = 1; byte <= module.bytes(); ++byte) {
    const std::uint32_t entry = (std::uint32_t{kOutputs} << 16U) | (static_cast<std::uint32_t>(byte) << 8U) | 8U;
    write(place_of(kRpdoMapping, byte), entry, 4);
  }
  write(place_of(kRpdoMapping, 0), static_cast<std::uint32_t>(module.bytes()), 1);
  write(place_of(kRpdoParameters, 2), kSynchronous, 1);
  write(place_of(kRpdoParameters, 1), identifier, 4);
  checks.back().mask = kWithoutBit30;

  const bool keeps = module.on_failure == OutputModule::OnFailure::keep;
  const bool lit = module.on_failure == OutputModule::OnFailure::lit;
  for (int byte = 1; byte <= module.bytes(); ++byte) {
    write(place_of(kErrorMode, byte), keeps ? 0x00 : 0xFF, 1);
    if (!keeps) write(place_of(kErrorValue, byte), lit ? 0xFF : 0x00, 1);
  }
  write(place_of(0x1016, 1), (kController << 16U) | in_ms(module.silence), 4);
  write(place_of(0x1017, 0), in_ms(module.heartbeat), 2);
  for (const ObjectValue& object : module.objects) {
    write(place_of(static_cast<std::uint16_t>(object.index), object.sub), object.value, object.bytes);
  }
  steps.insert(steps.end(), checks.begin(), checks.end());
  return steps;
}

std::string abort_meaning(std::uint32_t code) {
  static constexpr std::array<std::pair<std::uint32_t, std::string_view>, 17> kMeanings{{
      {0x05030000, "toggle bit not alternated"},
      {0x05040000, "no answer in time"},
      {0x05040001, "command not known"},
      {0x06010000, "access not supported"},
      {0x06010001, "it can only be written"},
      {0x06010002, "it can only be read"},
      {0x06020000, "the device has no such object"},
      {0x06040041, "the object cannot be mapped to the PDO"},
      {0x06040042, "more is mapped than the PDO can carry"},
      {0x06040043, "parameter incompatible"},
      {0x06060000, "hardware error"},
      {0x06070010, "wrong length"},
      {0x06090011, "the object has no such sub-index"},
      {0x06090030, "the value is not possible"},
      {0x08000000, "general error"},
      {0x08000021, "local control forbids it"},
      {0x08000022, "not in this state of the device"},
  }};
  const auto found = std::ranges::find(kMeanings, code, [](const auto& entry) { return entry.first; });
  return found == kMeanings.end() ? "a code of the device's own" : std::string(found->second);
}

CanFrame outputs(const OutputModule& module, std::uint8_t node, const std::vector<bool>& lit) {
  FL_CHECK(static_cast<int>(lit.size()) <= module.outputs);
  CanFrame frame;
  frame.id = static_cast<std::uint16_t>(0x200 + node);
  frame.length = static_cast<std::uint8_t>(module.bytes());
  for (std::size_t channel = 0; channel < lit.size(); ++channel) {
    if (lit[channel]) frame.data.at(channel / 8) |= static_cast<std::uint8_t>(1U << (channel % 8));
  }
  return frame;
}

ModuleSetup::ModuleSetup(OutputModule module, const std::vector<NodeAddress>& nodes) : module_(std::move(module)) {
  for (const NodeAddress& node : nodes) nodes_.push_back({node.unit(), State::idle, {}, {}});
}

std::size_t ModuleSetup::position(std::uint8_t address) const {
  const auto found = std::ranges::find(nodes_, address, &Node::address);
  FL_CHECK(found != nodes_.end());
  return static_cast<std::size_t>(found - nodes_.begin());
}

void ModuleSetup::want(std::uint8_t address, Instant now) {
  const std::size_t at = position(address);
  if (current_ == static_cast<std::ptrdiff_t>(at)) current_ = -1;
  Node& node = nodes_[at];
  node.state = State::wanted;
  node.from = now;
  node.complaint.clear();
}

void ModuleSetup::hear(const CanFrame& frame, Instant /*now*/) {
  if (under_way()) (void)sdo_.take(frame);  // nothing of ours is longer than four bytes
}

void ModuleSetup::ask(Instant now, std::deque<CanFrame>& outbox) {
  const SetupStep& step = steps_[step_];
  const std::uint8_t node = nodes_[static_cast<std::size_t>(current_)].address;
  if (step.reads()) {
    outbox.push_back(sdo_.read(node, step.place));
  } else {
    std::array<std::uint8_t, 4> bytes{};
    for (unsigned i = 0; i < 4; ++i) bytes.at(i) = static_cast<std::uint8_t>((step.value >> (8U * i)) & 0xFFU);
    outbox.push_back(sdo_.write(node, step.place, std::span(bytes).first(static_cast<std::size_t>(step.bytes))));
  }
  deadline_ = now + kTimeout;
}

/// Why the step that has ended ends the setup; empty: it does not.
std::string ModuleSetup::refusal_of_step() const {
  const SetupStep& step = steps_[step_];
  const std::string object = "object " + hexadecimal(step.place.index, 4) + ":" + std::to_string(int{step.place.sub});
  if (sdo_.state() == SdoClient::State::aborted) {
    return object +
           (step.reads() ? " cannot be read: " : " does not take " + hexadecimal(step.value, 2 * step.bytes) + ": ") +
           hexadecimal(sdo_.abort_code(), 8) + ", " + abort_meaning(sdo_.abort_code());
  }
  if (!step.reads()) return {};
  const std::uint32_t value = number_of(sdo_.data());
  if ((value & step.mask) == (step.value & step.mask)) return {};
  if (step.place.index == kDeviceType.index) {
    return object + " is " + hexadecimal(value, 8) + ": no module of digital outputs (CiA 401: 0x....0191, bit 17 set)";
  }
  return object + " is " + hexadecimal(value, 8) + " and should be " + hexadecimal(step.value, 8);
}

ModuleSetup::Outcome ModuleSetup::step(Instant now, bool may_begin, std::deque<CanFrame>& outbox) {
  Outcome outcome;
  if (!under_way()) {
    if (!may_begin) return outcome;
    const auto due =
        std::ranges::find_if(nodes_, [&](const Node& node) { return node.state == State::wanted && now >= node.from; });
    if (due == nodes_.end()) return outcome;
    current_ = due - nodes_.begin();
    steps_ = setup_steps(module_, due->address);
    step_ = 0;
    ask(now, outbox);
    return outcome;
  }
  Node& node = nodes_[static_cast<std::size_t>(current_)];
  if (sdo_.state() == SdoClient::State::waiting) {
    if (now < deadline_) return outcome;
    outbox.push_back(sdo_.give_up());
    node.from = now + kAgain;
    current_ = -1;
    outcome.silent = node.address;
    return outcome;
  }
  node.complaint = refusal_of_step();
  if (!node.complaint.empty()) {
    node.state = State::refused;
    current_ = -1;
    outcome.refused = node.address;
  } else if (++step_ == steps_.size()) {
    node.state = State::done;
    current_ = -1;
    outcome.done = node.address;
  } else {
    ask(now, outbox);
  }
  return outcome;
}

void ModuleSetup::abandon(Instant now) {
  if (under_way()) nodes_[static_cast<std::size_t>(current_)].from = now;
  current_ = -1;
}

Instant ModuleSetup::next() const {
  if (under_way()) return deadline_;
  Instant next = kNever;
  for (const Node& node : nodes_) {
    if (node.state == State::wanted) next = std::min(next, node.from);
  }
  return next;
}

std::vector<std::string> ModuleSetup::complaints() const {
  std::vector<std::string> out;
  for (const Node& node : nodes_) {
    if (!node.complaint.empty()) out.push_back("node " + std::to_string(int{node.address}) + ": " + node.complaint);
  }
  return out;
}

}  // namespace footlight::drivers::canopen
