// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "controller/node_health.hpp"
#include "core/result.hpp"
#include "core/time.hpp"
#include "drivers/driver.hpp"

namespace footlight::controller {

/// What discovery says of one address.
struct FoundNode {
  enum class Kind {
    present,  ///< one device, the same in every round
    twofold,  ///< several devices share the address, or answer over each other
    ghost,    ///< something was heard now and then, and never in the same way: noise, a loose wire
    absent,   ///< nobody; told of addresses that somebody expects
  };
  Kind kind = Kind::absent;
  std::uint16_t address = 0;
  bool expected = false;                      ///< the rig has a node there
  int rounds = 0;                             ///< questions
  int heard = 0;                              ///< of them, those with an answer that was understood
  int garbled = 0;                            ///< of them, those with an answer that nobody understands
  std::vector<drivers::Identity> identities;  ///< different ones; one where the device is present
};

[[nodiscard]] std::string_view to_text(FoundNode::Kind kind);

/// What a technician does on one bus: who is there, which is it, how is it, readdressing, a test of the cable. Pure
/// stepping over a driver; no show is on the bus meanwhile. Borrows the driver.
class BusService final : private drivers::EventSink {
 public:
  BusService(drivers::Driver& driver, const std::vector<drivers::NodeAddress>& nodes);

  /// Discovery: two passes over all addresses, then kRounds - 2 questions to those where anything was heard. Bounded:
  /// so many questions, each with its time-out. The same devices give the same list. One task at a time. Outside of
  /// scans and tests, which count, a question whose answer is lost is asked up to three times.
  static constexpr int kRounds = 6;
  void scan(std::uint16_t first, std::uint16_t last);
  void identify(std::uint16_t address, bool on);
  /// Finds out who is at `from`, moves it to `to`, and looks whether it is there.
  /// @param unique_id which of several devices at `from`
  void set_address(std::uint16_t from, std::optional<std::uint32_t> unique_id, std::uint16_t to,
                   bool counts_after_restart);
  /// Battery and the like; where nodes keep time, they are told it first and asked for it last, and how far their
  /// clocks are off is among the values.
  void ask_health(const std::vector<std::uint16_t>& addresses);
  /// What nodes keep of plan and patch. @param written the patch check that each is given first; empty: none
  void ask_patches(const std::vector<std::uint16_t>& addresses, const std::map<std::uint16_t, std::uint32_t>& written);
  /// Asks the nodes in turn, in the order given, until `duration` is over.
  void test(const std::vector<std::uint16_t>& addresses, Duration duration);

  /// Does what is due. @return when to call again if nothing arrives before
  Instant step(Instant now);
  [[nodiscard]] bool finished() const { return finished_; }
  /// Why the task could not be done; nothing when it has been.
  [[nodiscard]] const std::optional<Error>& failure() const { return failure_; }
  /// 0..1
  [[nodiscard]] double progress() const;

  [[nodiscard]] const std::vector<FoundNode>& found() const { return found_; }
  /// In the order in which the nodes were first asked.
  [[nodiscard]] const std::vector<NodeHealth>& health() const { return health_; }
  /// By address, of those that have told.
  [[nodiscard]] const std::map<std::uint16_t, drivers::KeptChecks>& kept() const { return kept_; }

 private:
  struct Question {
    drivers::Task task = drivers::Task::probe;
    std::uint16_t address = 0;
    unsigned round = 0;
    bool on = false;
    std::uint16_t to = 0;
    std::optional<std::uint32_t> unique_id{};
    std::optional<std::uint32_t> patch{};
    int again = 0;  ///< times that it was asked before: its answer was garbled, or did not come
  };
  enum class Phase { idle, sweep, rounds, asking, testing, before_move, move, after_move };

  void on_event(const drivers::DeviceEvent& event) override;
  void on_answer(const drivers::ServiceAnswer& answer) override;
  bool refuse(drivers::Task task);
  void fail(std::string message);
  drivers::SendStatus send(const Question& question);
  void ask_again(Question question);
  void conclude_question();
  void next_phase();
  void conclude_scan();
  void look_before_move();
  void look_after_move();
  NodeHealth& health_of(std::uint16_t address);

  drivers::Driver& driver_;
  std::vector<drivers::NodeAddress> nodes_;
  Phase phase_ = Phase::idle;
  std::deque<Question> questions_;
  std::size_t asked_ = 0;
  std::optional<Question> under_way_;
  std::vector<drivers::ServiceAnswer> answers_;  ///< to the question under way
  Instant now_;
  Instant asked_at_;
  Instant retry_at_;
  Instant down_since_ = kNever;
  Instant test_until_ = kNever;
  Duration test_time_{};
  std::vector<std::uint16_t> cable_;
  std::map<std::uint16_t, FoundNode> by_address_;
  Question move_;
  bool counts_after_restart_ = false;
  bool finished_ = true;
  std::optional<Error> failure_;
  std::vector<FoundNode> found_;
  std::vector<NodeHealth> health_;
  std::map<std::uint16_t, drivers::KeptChecks> kept_;
};

}  // namespace footlight::controller
