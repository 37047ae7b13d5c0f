// SPDX-License-Identifier: Apache-2.0
#include "controller/lamp.hpp"

namespace footlight::controller {

Lamp lamp_of(const CellUse& use, bool reserve) {
  const bool stands = use.stands.has_value() && !reserve;
  const std::optional<PerformerIndex> comes = use.walks_to ? use.walks_to : use.announced;
  if (!comes) return stands ? Lamp{LampRole::here, *use.stands} : Lamp{};
  if (stands) return {LampRole::handover, *comes};
  return {use.walks_to ? LampRole::arrive : LampRole::next, *comes};
}

Lamp wearable_of(PerformerIndex performer, const Doing& doing, bool reserve) {
  if (doing.goal) return {LampRole::arrive, performer};
  if (doing.next) return {LampRole::next, performer};
  return reserve ? Lamp{} : Lamp{LampRole::here, performer};
}

void uses_of(std::span<const Doing> doing, std::size_t cells, std::vector<CellUse>& uses,
             const std::vector<bool>& without) {
  uses.assign(cells, CellUse{});
  for (std::size_t p = 0; p < doing.size(); ++p) {
    if (!without.empty() && without[p]) continue;
    const Doing& d = doing[p];
    const auto performer = PerformerIndex::of(p);
    if (!d.goal) uses[d.cell.at()].stands = performer;
    if (d.goal) {
      CellUse& use = uses[d.goal->at()];
      if (!use.walks_to || d.arrives < use.arrives) {
        use.walks_to = performer;
        use.arrives = d.arrives;
      }
    }
    if (d.next) {
      CellUse& use = uses[d.next->at()];
      if (!use.announced || d.next_arrives < use.next_arrives) {
        use.announced = performer;
        use.next_arrives = d.next_arrives;
      }
    }
  }
}

LookChoice default_choice(LampRole role) {
  switch (role) {
    case LampRole::here:
      return {std::nullopt, Effect::steady, 255};
    case LampRole::arrive:
      return {std::nullopt, Effect::steady, 255};
    case LampRole::next:
      return {std::nullopt, Effect::count_down, 255};
    case LampRole::handover:
      return {std::nullopt, Effect::double_blink, 255};
  }
  return {};
}

namespace {

/// A bright colour becomes a deep one, a dark colour a pale one: the hue stays the group's.
Colour other_shade(Colour colour) {
  const int luma = (299 * colour.red + 587 * colour.green + 114 * colour.blue) / 1000;  // ITU-R BT.601
  const auto shade = [&](std::uint8_t value) {
    return static_cast<std::uint8_t>(luma >= 128 ? value * 35 / 100 : 255 - (255 - value) * 45 / 100);
  };
  return {shade(colour.red), shade(colour.green), shade(colour.blue)};
}

Effect other_rhythm(Effect effect) {
  switch (effect) {
    case Effect::steady:
      return Effect::pulse;
    case Effect::blink:
    case Effect::count_down:
    case Effect::pulse:
      return Effect::double_blink;
    case Effect::double_blink:
      return Effect::blink;
  }
  return effect;
}

}  // namespace

Look with_pattern(Look look, int pattern) {
  if ((pattern & 1) != 0) look.colour = other_shade(look.colour);
  if ((pattern & 2) != 0) look.effect = other_rhythm(look.effect);
  return look;
}

}  // namespace footlight::controller
