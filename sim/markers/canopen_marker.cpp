// SPDX-License-Identifier: Apache-2.0
#include "sim/markers/canopen_marker.hpp"

#include <algorithm>
#include <span>

namespace footlight::sim {
namespace {

constexpr std::uint16_t kNmt = 0x000;
constexpr std::uint16_t kSync = 0x080;
constexpr std::uint16_t kMpdo = 0x1FF;
constexpr std::uint16_t kSdoRequest = 0x600;
constexpr std::uint16_t kControllerHeartbeat = 0x77F;
constexpr std::uint8_t kOperational = 5;
constexpr std::uint16_t kPduTooShort = 0x8210;  // CiA 301, table 26: PDO not processed due to length error
constexpr std::uint16_t kFenced = 0xFF01;       // device specific: docs/wire-protocol.md, lead
constexpr std::uint8_t kGenericAndCommunicationError = 0x11;
constexpr int kLooksPerPdo = 8;

std::uint8_t low(std::uint16_t word) { return static_cast<std::uint8_t>(word & 0xFFU); }
std::uint8_t high(std::uint16_t word) { return static_cast<std::uint8_t>(word >> 8U); }

}  // namespace

void CanopenMarker::power_on() {
  nmt_ = NmtState::pre_operational;
  counters_ = {};
  sdo_.reset();
  refuses_ = false;
  tells_fence_ = false;
}

CanopenMarker::Reaction CanopenMarker::receive(const drivers::CanFrame& frame, Instant now) {
  if (frame.kind != drivers::CanFrame::Kind::classic || frame.length > 8) return Reaction::none;
  model_.settle(now);
  if (frame.id == kNmt) return manage(frame, now);
  if (frame.id == kControllerHeartbeat) {
    if (frame.length == 1 && frame.data[0] == kOperational) model_.heartbeat(now);
    return Reaction::none;
  }
  if (frame.id == kMpdo) {
    return nmt_ == NmtState::stopped ? Reaction::none : take_mpdo(frame, now);
  }
  if (frame.id == kSdoRequest + id_) {
    if (nmt_ == NmtState::stopped || frame.length != 8) return Reaction::none;
    const auto answer = sdo_.answer(std::span(frame.data).first<8>(), now);
    if (answer) sdo_answer_ = *answer;
    return answer ? Reaction::sdo : Reaction::none;
  }
  if (nmt_ != NmtState::operational || refuses(now)) return Reaction::none;
  if (frame.id == kSync) {
    if (frame.length != 1 || frame.data[0] == 0 || frame.data[0] > kHighestSequence) return Reaction::none;
    model_.take_staged(frame.data[0], now);
    return Reaction::status;
  }
  const int function = frame.id >> 7;
  const bool is_pdo = function == 4 || function == 6 || function == 8 || function == 10;  // 0x200, 0x300, 0x400, 0x500
  if (!is_pdo || (frame.id & 0x7FU) != id_) return Reaction::none;
  return take_pdo(function / 2 - 2, frame);
}

CanopenMarker::Reaction CanopenMarker::manage(const drivers::CanFrame& frame, Instant now) {
  switch (take_nmt(frame, id_, nmt_)) {
    case NmtReset::none:
      return Reaction::none;
    case NmtReset::communication:
      sdo_.reset();
      return Reaction::boot_up;
    case NmtReset::node:
      break;
  }
  model_.power_on(now);
  power_on();
  return Reaction::boot_up;
}

CanopenMarker::Reaction CanopenMarker::take_pdo(int number, const drivers::CanFrame& frame) {
  const int first = number * kLooksPerPdo;
  const int wanted = std::min(kLooksPerPdo, model_.channels() - first);
  if (wanted <= 0) return Reaction::none;
  const bool was_wrong = counters_.error_register != 0;
  tells_fence_ = false;
  counters_.error_register = frame.length < wanted ? kGenericAndCommunicationError : 0;
  if (frame.length < wanted) return Reaction::emergency;
  model_.stage(first, std::span(frame.data).first(static_cast<std::size_t>(wanted)));
  return was_wrong ? Reaction::emergency : Reaction::none;
}

CanopenMarker::Reaction CanopenMarker::take_mpdo(const drivers::CanFrame& frame, Instant now) {
  const auto& data = frame.data;
  const bool to_me = data[0] == 0x80 || data[0] == (0x80 | id_);  // destination address mode, all nodes or this one
  if (frame.length != 8 || !to_me || data[2] != 0x21) return Reaction::none;
  const std::uint32_t number =
      data[4] | (std::uint32_t{data[5]} << 8U) | (std::uint32_t{data[6]} << 16U) | (std::uint32_t{data[7]} << 24U);
  if (data[1] == 0x06 && data[3] == 0) return take_lead(number, now);
  if (refuses(now)) return Reaction::none;
  if (data[1] == 0x00) model_.set_colour(data[3], Colour{data[6], data[5], data[4]});
  if (data[1] == 0x01) model_.set_effect(data[3], data[4], data[5]);
  if (data[1] == 0x05 && data[3] == 1) model_.keep_plan(number);
  return Reaction::none;
}

/// Frames do not say whose they are: those that follow a refused LEAD are refused, until one is taken.
CanopenMarker::Reaction CanopenMarker::take_lead(std::uint32_t epoch, Instant now) {
  if (epoch == 0) return Reaction::none;
  fenced_by_ = model_.epoch(now);
  refuses_ = !model_.lead(epoch, 0, now);
  if (!refuses_) return Reaction::none;
  model_.drop_staged();
  tells_fence_ = true;
  return Reaction::emergency;
}

drivers::CanFrame CanopenMarker::status() const {
  const std::uint16_t crc = model_.crc();
  return {static_cast<std::uint16_t>(0x180 + id_),
          8,
          {model_.shown_sequence(), static_cast<std::uint8_t>(model_.state()), low(crc), high(crc), low(model_.boots()),
           high(model_.boots()), low(counters_.errors), high(counters_.errors)}};
}

drivers::CanFrame CanopenMarker::heartbeat() const {
  return {static_cast<std::uint16_t>(0x700 + id_), 1, {static_cast<std::uint8_t>(nmt_)}};
}

drivers::CanFrame CanopenMarker::boot_up() const { return {static_cast<std::uint16_t>(0x700 + id_), 1, {}}; }

drivers::CanFrame CanopenMarker::emergency() const {
  if (tells_fence_) {
    return {static_cast<std::uint16_t>(0x080 + id_),
            8,
            {low(kFenced), high(kFenced), counters_.error_register, static_cast<std::uint8_t>(fenced_by_),
             static_cast<std::uint8_t>(fenced_by_ >> 8U), static_cast<std::uint8_t>(fenced_by_ >> 16U),
             static_cast<std::uint8_t>(fenced_by_ >> 24U), 0}};
  }
  const std::uint16_t code = counters_.error_register == 0 ? 0 : kPduTooShort;
  return {static_cast<std::uint16_t>(0x080 + id_), 8, {low(code), high(code), counters_.error_register}};
}

}  // namespace footlight::sim
