// SPDX-License-Identifier: Apache-2.0
#include "sim/markers/node_model.hpp"

#include <algorithm>

#include "core/check.hpp"
#include "sim/markers/check_sums.hpp"

namespace footlight::sim {
namespace {

constexpr int kEffects = 5;

}  // namespace

NodeModel::NodeModel(int channels, bool has_lease, LookIndex at_power_on)
    : channels_(channels), has_lease_(has_lease), at_power_on_(at_power_on) {
  FL_CHECK(channels >= 1 && channels <= kChannelsPerNode);
}

void NodeModel::power_on(Instant now) {
  showing_.fill(at_power_on_);
  pending_.fill(kDark);
  shown_sequence_ = 0;
  pending_sequence_ = 0;
  staged_ = false;
  state_ = NodeState::boot;
  ++boots_;
  powered_on_at_ = now;
  renewed_ = now;
  identify_until_ = now;
  table_.fill(Look{{255, 255, 255}, Effect::steady, 255});
  table_[kDark] = Look{{0, 0, 0}, Effect::steady, 0};
  table_[kNoGuidance] = no_guidance_look();
}

void NodeModel::preload(std::uint8_t sequence, std::uint8_t plan_byte, int first, std::span<const LookIndex> looks) {
  FL_CHECK(first >= 0 && first + static_cast<int>(looks.size()) <= channels_);
  pending_ = showing_;
  std::copy(looks.begin(), looks.end(), pending_.begin() + first);
  pending_sequence_ = sequence;
  pending_plan_ = plan_byte;
}

bool NodeModel::latch(std::uint8_t sequence, std::optional<std::uint8_t> plan_byte, Instant now) {
  settle(now);
  if (sequence == 0 || sequence != pending_sequence_) return false;
  if (plan_byte && *plan_byte != pending_plan_) return false;
  take(sequence, now);
  return true;
}

void NodeModel::stage(int first, std::span<const LookIndex> looks) {
  FL_CHECK(first >= 0 && first + static_cast<int>(looks.size()) <= channels_);
  if (!staged_) pending_ = showing_;
  staged_ = true;
  std::copy(looks.begin(), looks.end(), pending_.begin() + first);
}

bool NodeModel::take_staged(std::uint8_t sequence, Instant now) {
  settle(now);
  shown_sequence_ = sequence;
  if (!staged_) return false;
  take(sequence, now);
  return true;
}

void NodeModel::take(std::uint8_t sequence, Instant now) {
  // Who shows nothing to be leased starts a lease with its first looks: guidance must never outlive a silent
  // controller.
  if (state_ == NodeState::boot || state_ == NodeState::no_guidance) renewed_ = now;
  showing_ = pending_;
  shown_sequence_ = sequence;
  pending_sequence_ = 0;
  staged_ = false;
  if (state_ != NodeState::hold) state_ = NodeState::showing;
  ++latches_;
}

void NodeModel::heartbeat(Instant now) {
  settle(now);
  renewed_ = now;
  if (state_ == NodeState::hold) state_ = NodeState::showing;
}

void NodeModel::settle(Instant now) {
  if (!has_lease_ || (state_ != NodeState::showing && state_ != NodeState::hold)) return;
  if (now >= renewed_ + kNoGuidanceAfter) {
    state_ = NodeState::no_guidance;
    showing_.fill(kNoGuidance);
    pending_sequence_ = 0;
    staged_ = false;
  } else if (now >= renewed_ + kHoldAfter) {
    state_ = NodeState::hold;
  }
}

Instant NodeModel::lease_end() const {
  if (!has_lease_) return kNever;
  if (state_ == NodeState::showing) return renewed_ + kHoldAfter;
  if (state_ == NodeState::hold) return renewed_ + kNoGuidanceAfter;
  return kNever;
}

bool NodeModel::set_look(std::uint8_t index, Look look) {
  return set_effect(index, static_cast<std::uint8_t>(look.effect), look.brightness) && set_colour(index, look.colour);
}

bool NodeModel::set_colour(std::uint8_t index, Colour colour) {
  if (index == kDark || index == kNoGuidance) return false;
  table_[index].colour = colour;
  return true;
}

bool NodeModel::set_effect(std::uint8_t index, std::uint8_t effect, std::uint8_t brightness) {
  if (index == kDark || index == kNoGuidance || effect >= kEffects) return false;
  table_[index].effect = static_cast<Effect>(effect);
  table_[index].brightness = brightness;
  return true;
}

std::uint16_t NodeModel::crc() const {
  return crc16_ccitt(std::span<const std::uint8_t>(showing_).first(static_cast<std::size_t>(channels_)));
}

}  // namespace footlight::sim
