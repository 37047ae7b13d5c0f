// SPDX-License-Identifier: Apache-2.0
#include "controller/bus_service.hpp"

#include <algorithm>
#include <utility>

#include "core/check.hpp"

namespace footlight::controller {
namespace {

using drivers::SendStatus;
using drivers::ServiceAnswer;
using drivers::Task;
using Kind = FoundNode::Kind;

constexpr int kSweeps = 2;  // over all addresses
constexpr Duration kRetry = milliseconds(1);
constexpr int kAgain = 3;
constexpr std::uint16_t kEverybody = 0;
constexpr int kAsksOfTarget = 4;  // that nobody is at a new address must be sure
constexpr Duration kSettle = milliseconds(10);
constexpr Duration kGiveUpDown = milliseconds(1000);
constexpr Duration kRestart = milliseconds(500);  // a node that has moved may want a moment

std::string hexadecimal(std::uint32_t value) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string text = "0x";
  for (int shift = 28; shift >= 0; shift -= 4) text += kDigits[(value >> static_cast<unsigned>(shift)) & 0xFU];
  return text;
}

/// A device that has told less of itself this time is the same device.
void keep_identity(std::vector<drivers::Identity>& known, const drivers::Identity& identity) {
  for (drivers::Identity& other : known) {
    if (other == identity) return;
    if (!identity.unique_id || other.unique_id != identity.unique_id) continue;
    if (other.model.empty()) other = identity;
    return;
  }
  known.push_back(identity);
}

}  // namespace

std::string_view to_text(Kind kind) {
  switch (kind) {
    case Kind::present:
      return "present";
    case Kind::twofold:
      return "double";
    case Kind::ghost:
      return "ghost";
    case Kind::absent:
      return "absent";
  }
  return "absent";
}

BusService::BusService(drivers::Driver& driver, const std::vector<drivers::NodeAddress>& nodes)
    : driver_(driver), nodes_(nodes) {}

bool BusService::refuse(Task task) {
  FL_CHECK(finished_);
  failure_.reset();
  const std::string_view refusal = driver_.refusal(task);
  if (refusal.empty()) {
    finished_ = false;
    asked_ = 0;
    questions_.clear();
    return false;
  }
  fail(std::string(driver_.language()) + " cannot " + std::string(to_text(task)) + ": " + std::string(refusal));
  return true;
}

void BusService::fail(std::string message) {
  failure_ = device_error(std::move(message));
  finished_ = true;
  phase_ = Phase::idle;
  questions_.clear();
  under_way_.reset();
}

void BusService::scan(std::uint16_t first, std::uint16_t last) {
  FL_CHECK(first >= 1 && first <= last);
  if (refuse(Task::probe)) return;
  found_.clear();
  by_address_.clear();
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (int address = first; address <= last; ++address) {
      questions_.push_back({Task::probe, static_cast<std::uint16_t>(address)});
    }
  }
  phase_ = Phase::sweep;
}

void BusService::identify(std::uint16_t address, bool on) {
  if (refuse(Task::identify)) return;
  Question question{Task::identify, address};
  question.on = on;
  questions_.push_back(question);
  phase_ = Phase::asking;
}

void BusService::set_address(std::uint16_t from, std::optional<std::uint32_t> unique_id, std::uint16_t to,
                             bool counts_after_restart) {
  if (refuse(Task::set_address)) return;
  move_ = {Task::set_address, from};
  move_.to = to;
  move_.unique_id = unique_id;
  counts_after_restart_ = counts_after_restart;
  by_address_.clear();
  for (unsigned round = 0; round < kRounds; ++round) questions_.push_back({Task::probe, from, round});
  for (int time = 0; time < kAsksOfTarget; ++time) questions_.push_back({Task::probe, to, 0});
  phase_ = Phase::before_move;
}

void BusService::ask_health(const std::vector<std::uint16_t>& addresses) {
  if (refuse(Task::health)) return;
  const bool clocks = driver_.refusal(Task::clock).empty();
  if (clocks) questions_.push_back({Task::clock, kEverybody});
  for (const std::uint16_t address : addresses) questions_.push_back({Task::health, address});
  for (const std::uint16_t address : addresses) {
    if (clocks) questions_.push_back({Task::clock, address});
  }
  phase_ = Phase::asking;
}

void BusService::ask_patches(const std::vector<std::uint16_t>& addresses,
                             const std::map<std::uint16_t, std::uint32_t>& written) {
  if (refuse(Task::patch)) return;
  kept_.clear();
  for (const std::uint16_t address : addresses) {
    Question question{Task::patch, address};
    if (const auto patch = written.find(address); patch != written.end()) question.patch = patch->second;
    questions_.push_back(question);
  }
  phase_ = Phase::asking;
}

void BusService::test(const std::vector<std::uint16_t>& addresses, Duration duration) {
  if (refuse(Task::probe)) return;
  cable_ = addresses;
  test_time_ = duration;
  test_until_ = kNever;
  phase_ = Phase::testing;
}

double BusService::progress() const {
  if (finished_) return 1;
  if (phase_ == Phase::testing) {
    return test_until_ == kNever ? 0 : 1 - to_seconds(test_until_ - now_) / std::max(1e-9, to_seconds(test_time_));
  }
  return static_cast<double>(asked_) / static_cast<double>(std::max<std::size_t>(1, asked_ + questions_.size() + 1));
}

NodeHealth& BusService::health_of(std::uint16_t address) {
  const auto found = std::ranges::find(health_, address, &NodeHealth::address);
  if (found != health_.end()) return *found;
  NodeHealth& node = health_.emplace_back();
  node.address = address;
  return node;
}

SendStatus BusService::send(const Question& question) {
  switch (question.task) {
    case Task::probe:
      return driver_.probe(question.address, question.round, now_);
    case Task::identify:
      return driver_.identify(question.address, question.on, now_);
    case Task::set_address:
      return driver_.set_address(question.address, question.unique_id, question.to, now_);
    case Task::health:
      return driver_.ask_health(question.address, now_);
    case Task::clock:
      if (question.address == kEverybody) return driver_.sync_time(now_ - kStart, 1, now_);
      return driver_.ask_clock(question.address, now_);
    case Task::patch:
      return driver_.ask_patch(question.address, question.patch, now_);
  }
  return SendStatus::down;
}

Instant BusService::step(Instant now) {
  now_ = now;
  const Instant wish = driver_.step(now, *this);
  while (!finished_) {
    if (under_way_) {
      if (!driver_.ready()) return wish;
      conclude_question();
    }
    if (now < retry_at_) return std::min(wish, retry_at_);
    if (questions_.empty()) {
      next_phase();
      continue;
    }
    if (!driver_.ready()) return std::min(wish, now + kRetry);
    const SendStatus status = send(questions_.front());
    if (status == SendStatus::accepted) {
      under_way_ = questions_.front();
      questions_.pop_front();
      answers_.clear();
      asked_at_ = now;
      ++asked_;
      down_since_ = kNever;
      return now;  // a port that blocks has the answer already: it is told at the time that it is then
    }
    if (status == SendStatus::down) {
      if (down_since_ == kNever) down_since_ = now;
      if (now - down_since_ >= kGiveUpDown) {
        fail("the wire is gone (is the adapter plugged in, the gateway switched on?)");
        break;
      }
    }
    retry_at_ = now + kRetry;
  }
  return finished_ ? kNever : wish;
}

void BusService::on_event(const drivers::DeviceEvent& /*event*/) {}

void BusService::on_answer(const ServiceAnswer& answer) {
  if (!under_way_) return;
  answers_.push_back(answer);
  NodeHealth& node = health_of(under_way_->address);
  if (under_way_->task == Task::clock) {
    node.values.insert(node.values.end(), answer.health.begin(), answer.health.end());
    return;
  }
  if (answer.kind == ServiceAnswer::Kind::found || answer.kind == ServiceAnswer::Kind::done) {
    node.last_seen = now_;
    if (answers_.size() == 1) node.latency.add(now_ - asked_at_);
    if (!answer.health.empty()) node.values = answer.health;
    if (under_way_->task == Task::patch) kept_[under_way_->address] = answer.kept;
  }
}

void BusService::ask_again(Question question) {
  ++question.again;
  questions_.push_front(question);
  retry_at_ = now_ + kSettle;
}

void BusService::conclude_question() {
  const Question question = *std::exchange(under_way_, std::nullopt);
  if (question.task == Task::clock && question.address == kEverybody) return;  // nobody answers
  const auto count = [&](ServiceAnswer::Kind kind) { return std::ranges::count(answers_, kind, &ServiceAnswer::kind); };
  const auto understood = count(ServiceAnswer::Kind::found) + count(ServiceAnswer::Kind::done);
  const bool garbled = count(ServiceAnswer::Kind::garbled) > 0;
  const bool refused = count(ServiceAnswer::Kind::refused) > 0;
  if (garbled && understood == 0 && question.task == Task::probe && phase_ != Phase::testing &&
      question.again < kAgain) {
    // Perhaps the end of somebody else's answer: it counts when it comes again.
    ask_again(question);
    return;
  }
  if (question.task == Task::clock) {
    if (understood == 0 && question.again + 1 < kAgain) ask_again(question);
    return;
  }
  NodeHealth& node = health_of(question.address);
  ++node.asked;
  node.answered += understood > 0 ? 1 : 0;
  node.garbled += understood == 0 && garbled ? 1 : 0;
  node.refused += refused ? 1 : 0;
  node.silent += understood == 0 && !garbled && !refused ? 1 : 0;
  if (question.task == Task::probe && phase_ != Phase::testing) {
    FoundNode& found = by_address_[question.address];
    found.address = question.address;
    ++found.rounds;
    found.heard += understood > 0 ? 1 : 0;
    found.garbled += understood == 0 && garbled ? 1 : 0;
    // Somebody else of this address may still be answering.
    if (understood > 0 || garbled) retry_at_ = now_ + kSettle;
    for (const ServiceAnswer& answer : answers_) {
      if (answer.kind != ServiceAnswer::Kind::found || answer.identity == drivers::Identity{}) continue;
      keep_identity(found.identities, answer.identity);
    }
    return;
  }
  if (question.task == Task::probe || understood > 0) return;
  if (!refused && question.again + 1 < kAgain) {
    ask_again(question);
    return;
  }
  const std::string who = "the node of address " + std::to_string(question.address);
  const std::string task(to_text(question.task));
  if (question.task == Task::health || question.task == Task::patch) return;  // its record says so
  // Perhaps it has moved, and its word for it was lost: what is at the new address tells.
  if (question.task == Task::set_address && !refused && !counts_after_restart_) return;
  if (refused) {
    fail(who + " refuses to " + task + " (Modbus exception " + std::to_string(answers_.front().detail) + ")");
  } else {
    fail(who + " does not answer to " + task + (garbled ? " in a way that can be understood" : "") +
         " (footlight devices scan shows who is there)");
  }
}

void BusService::next_phase() {
  switch (phase_) {
    case Phase::sweep:
      phase_ = Phase::rounds;
      for (unsigned round = 1; round + kSweeps <= kRounds; ++round) {
        for (const auto& [address, found] : by_address_) {
          if (found.heard + found.garbled > 0) questions_.push_back({Task::probe, address, round});
        }
      }
      return;
    case Phase::rounds:
      conclude_scan();
      finished_ = true;
      return;
    case Phase::testing:
      if (test_until_ == kNever) test_until_ = now_ + test_time_;
      if (now_ >= test_until_ || cable_.empty()) {
        finished_ = true;
        return;
      }
      for (const std::uint16_t address : cable_) questions_.push_back({Task::probe, address});
      return;
    case Phase::before_move:
      look_before_move();
      return;
    case Phase::move:
      if (counts_after_restart_) {
        finished_ = true;
        return;
      }
      phase_ = Phase::after_move;
      by_address_.clear();
      retry_at_ = now_ + kRestart;
      for (unsigned round = 1; round <= kSweeps; ++round) questions_.push_back({Task::probe, move_.to, round});
      return;
    case Phase::after_move:
      look_after_move();
      return;
    case Phase::idle:
    case Phase::asking:
      finished_ = true;
      return;
  }
}

void BusService::conclude_scan() {
  for (const drivers::NodeAddress& node : nodes_) {
    const auto found = by_address_.find(node.address);
    if (found != by_address_.end()) found->second.expected = true;
  }
  for (auto& [address, found] : by_address_) {
    const int noticed = found.heard + found.garbled;
    if (noticed == 0) {
      if (found.expected) found_.push_back(found);
      continue;
    }
    if (found.identities.size() > 1 || (2 * found.garbled >= found.rounds && found.garbled > 1)) {
      found.kind = Kind::twofold;
    } else if (found.heard > 1) {  // nothing but a device says the same thing twice
      found.kind = Kind::present;
    } else {
      found.kind = Kind::ghost;
    }
    found_.push_back(found);
  }
}

void BusService::look_before_move() {
  const FoundNode& at = by_address_[move_.address];
  const FoundNode& target = by_address_[move_.to];
  const std::string from = std::to_string(move_.address);
  if (at.heard + at.garbled == 0) {
    return fail("nobody answers at address " + from + " (footlight devices scan shows who is there)");
  }
  if (target.heard + target.garbled > 0 && move_.to != move_.address) {
    return fail("address " + std::to_string(move_.to) + " is taken already (choose a free one)");
  }
  const auto has = [&](std::uint32_t id) {
    return std::ranges::any_of(at.identities, [&](const auto& identity) { return identity.unique_id == id; });
  };
  if (move_.unique_id && !has(*move_.unique_id)) {
    return fail("no device of the unique id " + hexadecimal(*move_.unique_id) + " answers at address " + from);
  }
  if (!move_.unique_id && at.identities.size() > 1) {
    std::string ids;
    for (const auto& identity : at.identities) {
      ids += (ids.empty() ? "" : ", ") + (identity.unique_id ? hexadecimal(*identity.unique_id) : identity.model);
    }
    return fail(std::to_string(at.identities.size()) + " devices share address " + from +
                ": say which one by its unique id (" + ids + ")");
  }
  if (!move_.unique_id && at.heard == 0) {
    return fail("several devices answer over each other at address " + from + " (take all but one off the line)");
  }
  if (!move_.unique_id && !at.identities.empty()) move_.unique_id = at.identities.front().unique_id;
  phase_ = Phase::move;
  questions_.push_back(move_);
}

void BusService::look_after_move() {
  const FoundNode& at = by_address_[move_.to];
  const bool same = !move_.unique_id || std::ranges::any_of(at.identities, [&](const auto& identity) {
    return identity.unique_id == move_.unique_id;
  });
  if (at.heard == 0 || !same) {
    return fail("the device does not answer at address " + std::to_string(move_.to) +
                " afterwards (switch it off and on, then scan)");
  }
  finished_ = true;
}

}  // namespace footlight::controller
