// SPDX-License-Identifier: Apache-2.0
#include "sim/markers/node_model.hpp"

#include <algorithm>
#include <cmath>

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
  epoch_ = 0;
  content_.fill({});
  pending_content_.fill({});
  times_set_ = 0;
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
  for (std::size_t c = 0; c < content_.size(); ++c) {
    if (pending_content_[c].sequence != sequence) continue;
    content_[c] = pending_content_[c].content;
    pending_content_[c].sequence = 0;
  }
  ++latches_;
}

void NodeModel::set_content(std::uint8_t sequence, int channel, const NodeContent& content) {
  FL_CHECK(channel >= 0 && channel < channels_);
  const auto c = static_cast<std::size_t>(channel);
  if (sequence == shown_sequence_) {
    content_[c] = content;
  } else {
    pending_content_[c] = {sequence, content};
  }
}

void NodeModel::set_time(Instant now, Duration show_time, double rate) {
  time_set_at_ = now;
  time_then_ = show_time;
  rate_ = rate;
  ++times_set_;
}

std::optional<Duration> NodeModel::show_time(Instant now) const {
  if (times_set_ == 0) return std::nullopt;
  return time_then_ + Duration(std::llround(static_cast<double>((now - time_set_at_).count()) * rate_));
}

std::optional<int> NodeModel::counts_left(int channel, Instant now) const {
  const NodeContent& content = this->content(channel);
  const auto time = show_time(now);
  if (!content.walks || content.count_ms == 0 || !time) return std::nullopt;
  const auto ms = static_cast<std::uint32_t>(*time / milliseconds(1));
  const auto left = static_cast<std::int32_t>(content.starts_ms - ms);  // modulo 2^32
  if (left <= 0) return 0;
  return (left + content.count_ms - 1) / content.count_ms;
}

bool NodeModel::lead(std::uint32_t epoch, std::uint8_t plan_byte, Instant now) {
  settle(now);
  if (epoch == 0 || (led(now) && epoch < epoch_)) return false;
  epoch_ = epoch;
  leader_ = plan_byte;
  led_at_ = now;
  return true;
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
