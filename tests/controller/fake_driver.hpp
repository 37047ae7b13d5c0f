// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "controller/bus_loop.hpp"
#include "controller/cue_schedule.hpp"
#include "drivers/driver.hpp"

namespace footlight::controller {

/// A wire and its nodes in one, as simple as they can be: every operation takes its time, everything that a frame does
/// may be lost by script. Nodes behave as docs/wire-protocol.md, section 1, without lease.
class FakeDriver final : public drivers::Driver {
 public:
  enum class Kind { start, preload, latch, heartbeat, ask, upload, tell_plan, ask_kept };
  struct Operation {
    Kind kind;
    NodeIndex node;
    drivers::Sequence sequence;
    Instant at;
  };
  struct Node {
    std::vector<LookIndex> showing;
    std::vector<LookIndex> pending;
    drivers::Sequence shown_sequence = 0;
    drivers::Sequence pending_sequence = 0;
    std::uint8_t state = 0;
    std::uint16_t boots = 1;
    std::uint16_t known_boots = 1;
    bool dead = false;
    drivers::KeptChecks kept{0, 0};
    bool tells_kept = true;
  };

  FakeDriver(std::size_t nodes, std::size_t channels, bool canopen, bool keeps_checks = false)
      : canopen_(canopen), keeps_checks_(keeps_checks) {
    nodes_.resize(nodes);
    for (Node& node : nodes_) node.showing.assign(channels, kNoGuidance);
  }

  std::vector<Operation> log;
  std::vector<std::string> broken_rules;
  /// True: node does not hear this operation (or its answer does not arrive, for `ask` and receipts).
  std::function<bool(Kind, NodeIndex, Instant)> lost = [](Kind, NodeIndex, Instant) { return false; };
  std::function<bool(NodeIndex, Instant)> answer_lost = [](NodeIndex, Instant) { return false; };

  /// What a node says to a preload instead of taking it; nothing: it takes it.
  std::function<std::optional<drivers::DeviceEvent::Again>(NodeIndex)> refuses = [](NodeIndex) {
    return std::optional<drivers::DeviceEvent::Again>{};
  };

  /// Who has not heard that this controller leads: it refuses preloads and takes no look until a heartbeat reaches it.
  std::vector<NodeIndex> fenced;

  [[nodiscard]] Node& node(std::size_t n) { return nodes_[n]; }
  void reboot(std::size_t n) {
    Node& node = nodes_[n];
    std::fill(node.showing.begin(), node.showing.end(), kNoGuidance);
    node.pending_sequence = node.shown_sequence = node.state = 0;
    node.pending.clear();
    ++node.boots;
  }
  [[nodiscard]] std::size_t count(Kind kind) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(log, [&](const Operation& operation) { return operation.kind == kind; }));
  }

  /// Lamps are on or off.
  bool relays = false;
  [[nodiscard]] Look shown(const Look& look) const override {
    return relays && look.brightness > 0 ? Look{{255, 255, 255}, Effect::steady, 255} : look;
  }

  [[nodiscard]] std::string_view language() const override { return "fake"; }
  [[nodiscard]] drivers::Capabilities capabilities() const override {
    drivers::Capabilities can;
    can.sequenced_latch = !canopen_;
    can.pushes_status = canopen_;
    can.keeps_checks = keeps_checks_;
    return can;
  }
  [[nodiscard]] Duration preload_time(int) const override { return milliseconds(4); }
  [[nodiscard]] Duration status_time() const override { return milliseconds(3); }
  [[nodiscard]] Duration latch_time() const override { return milliseconds(1); }
  [[nodiscard]] Duration heartbeat_time() const override { return milliseconds(1); }
  [[nodiscard]] Duration upload_time() const override { return milliseconds(1); }
  [[nodiscard]] bool ready() const override { return !busy_; }

  drivers::SendStatus start(Instant now) override { return take({Kind::start, {}, 0, now}, milliseconds(1)); }
  drivers::SendStatus preload(const drivers::NodeAddress& address, drivers::Sequence sequence,
                              std::span<const LookIndex> looks, Instant now) override {
    if (busy_) return drivers::SendStatus::busy;
    looks_.assign(looks.begin(), looks.end());
    preloaded_since_latch_[address.node.at()] = sequence;
    return take({Kind::preload, address.node, sequence, now}, milliseconds(4));
  }
  drivers::SendStatus latch(drivers::Sequence sequence, Instant now) override {
    if (busy_) return drivers::SendStatus::busy;
    // Sequences of one test do not wrap.
    for (const auto& [node, preloaded] : preloaded_since_latch_) {
      if (canopen_ && preloaded > sequence) {
        broken_rules.push_back("SYNC " + std::to_string(sequence) + " takes looks of " + std::to_string(preloaded));
      }
    }
    preloaded_since_latch_.clear();
    return take({Kind::latch, {}, sequence, now}, milliseconds(1));
  }
  drivers::SendStatus heartbeat(Duration, Instant now) override {
    return take({Kind::heartbeat, {}, 0, now}, milliseconds(1));
  }
  drivers::SendStatus ask(const drivers::NodeAddress& address, Instant now) override {
    return take({Kind::ask, address.node, 0, now}, milliseconds(3));
  }
  [[nodiscard]] Duration kept_time() const override { return milliseconds(3); }
  drivers::SendStatus tell_plan(std::uint32_t check, Instant now) override {
    const auto status = take({Kind::tell_plan, {}, 0, now}, milliseconds(1));
    for (std::size_t n = 0; n < nodes_.size() && status == drivers::SendStatus::accepted; ++n) {
      if (!nodes_[n].dead && !lost(Kind::tell_plan, NodeIndex::of(n), now)) nodes_[n].kept.plan = check;
    }
    return status;
  }
  drivers::SendStatus ask_kept(const drivers::NodeAddress& address, Instant now) override {
    return take({Kind::ask_kept, address.node, 0, now}, milliseconds(3));
  }
  drivers::SendStatus upload_look(LookIndex index, const Look&, Instant now) override {
    return take({Kind::upload, {}, index, now}, milliseconds(1));
  }

  Instant step(Instant now, drivers::EventSink& events) override {
    if (busy_ && now >= done_at_) {
      const Operation operation = *busy_;
      busy_.reset();
      finish(operation, events);
    }
    if (now >= answers_at_) {
      answers_at_ = kNever;
      for (std::size_t n = 0; n < nodes_.size(); ++n) answer(n, now, events);
    }
    return std::min(busy_ ? done_at_ : kNever, answers_at_);
  }

 private:
  drivers::SendStatus take(Operation operation, Duration time) {
    if (busy_) return drivers::SendStatus::busy;
    log.push_back(operation);
    busy_ = operation;
    done_at_ = operation.at + time;
    return drivers::SendStatus::accepted;
  }

  void finish(const Operation& operation, drivers::EventSink& events) {
    using Event = drivers::DeviceEvent;
    if (operation.kind == Kind::preload) {
      if (const auto again = refuses(operation.node)) {
        Event refusal{Event::Kind::rejected, operation.node, operation.sequence};
        refusal.again = *again;
        return events.on_event(refusal);
      }
      if (std::ranges::find(fenced, operation.node) != fenced.end()) {
        return events.on_event({Event::Kind::fenced, operation.node, operation.sequence});
      }
      Node& node = nodes_[operation.node.at()];
      const bool heard = !node.dead && !lost(operation.kind, operation.node, operation.at);
      if (heard) {
        node.pending = looks_;
        node.pending_sequence = operation.sequence;
      }
      const bool receipt = canopen_ || (heard && !answer_lost(operation.node, operation.at));
      events.on_event({receipt ? Event::Kind::preloaded : Event::Kind::missed, operation.node, operation.sequence});
    } else if (operation.kind == Kind::latch) {
      for (std::size_t n = 0; n < nodes_.size(); ++n) hear_latch(n, operation);
      if (canopen_) answers_at_ = done_at_ + milliseconds(20);
    } else if (operation.kind == Kind::heartbeat) {
      std::erase_if(fenced, [&](NodeIndex n) { return !lost(Kind::heartbeat, n, operation.at); });
    } else if (operation.kind == Kind::ask_kept) {
      const Node& node = nodes_[operation.node.at()];
      if (node.dead || !node.tells_kept || answer_lost(operation.node, operation.at)) return;
      Event event{Event::Kind::keeps, operation.node};
      event.kept = node.kept;
      events.on_event(event);
    } else if (operation.kind == Kind::ask) {
      answer(operation.node.at(), operation.at, events);
    }
  }

  void hear_latch(std::size_t n, const Operation& operation) {
    Node& node = nodes_[n];
    asked_.resize(nodes_.size());
    asked_[n] = !node.dead && !lost(Kind::latch, NodeIndex::of(n), operation.at);
    if (!asked_[n]) return;
    if (canopen_) node.shown_sequence = operation.sequence;
    if (node.pending_sequence == 0 || (!canopen_ && node.pending_sequence != operation.sequence)) return;
    node.showing = node.pending;
    node.shown_sequence = operation.sequence;
    node.pending_sequence = 0;
    node.state = 1;
  }

  void answer(std::size_t n, Instant at, drivers::EventSink& events) {
    using Event = drivers::DeviceEvent;
    Node& node = nodes_[n];
    const auto index = NodeIndex::of(n);
    const bool asked = canopen_ ? asked_[n] : !node.dead && !lost(Kind::ask, index, at);
    if (!asked || node.dead || answer_lost(index, at)) {
      events.on_event({Event::Kind::missed, index});
      return;
    }
    if (node.boots != node.known_boots) {
      node.known_boots = node.boots;
      events.on_event({Event::Kind::booted, index});
    }
    Event event{Event::Kind::showing, index, node.shown_sequence};
    event.crc = drivers::looks_crc(node.showing);
    event.state = node.state;
    event.boots = node.boots;
    events.on_event(event);
  }

  bool canopen_;
  bool keeps_checks_;
  std::vector<Node> nodes_;
  std::vector<bool> asked_;
  std::vector<LookIndex> looks_;
  std::map<std::size_t, drivers::Sequence> preloaded_since_latch_;  ///< by node: the last one holds
  std::optional<Operation> busy_;
  Instant done_at_ = kNever;
  Instant answers_at_ = kNever;
};

}  // namespace footlight::controller
