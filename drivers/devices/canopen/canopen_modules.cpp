// SPDX-License-Identifier: Apache-2.0
// What is particular to a CANopen bus of output modules. What it has in common with our markers: canopen_driver.cpp.
#include <string>

#include "drivers/devices/canopen/canopen_driver.hpp"

namespace footlight::drivers {

std::string CanopenDriver::assumption() const {
  if (!setup_) return {};
  std::string text =
      "outputs are not read back: what has left for a module that sends heartbeats is taken for shown; a lamp is on or "
      "off";
  if (setup_->module().on_failure == OutputModule::OnFailure::keep) {
    text += "; it keeps its outputs when the controller is silent";
  }
  return text;
}

std::vector<std::string> CanopenDriver::complaints() const {
  return setup_ ? setup_->complaints() : std::vector<std::string>{};
}

Look CanopenDriver::shown(const Look& look) const {
  const bool dark = look.brightness == 0 || look.colour == Colour{};
  return setup_ && !dark ? Look{{255, 255, 255}, Effect::steady, 255} : look;
}

Look CanopenDriver::unguided() const {
  if (!setup_) return no_guidance_look();
  const bool lit = setup_->module().on_failure == OutputModule::OnFailure::lit;
  return {{255, 255, 255}, Effect::steady, static_cast<std::uint8_t>(lit ? 255 : 0)};
}

void CanopenDriver::set_up_on(Instant now, EventSink& events) {
  if (!started_ || down()) return;
  const auto outcome = setup_->step(now, !service_, outbox_);
  if (outcome.done != 0) {
    NodeState* node = find(outcome.done);
    node->start_due = true;
    node->operational = false;
  }
  if (outcome.silent != 0) events.on_event({DeviceEvent::Kind::missed, find(outcome.silent)->address.node});
}

}  // namespace footlight::drivers
