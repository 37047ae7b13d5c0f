// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <deque>
#include <memory>
#include <vector>

#include "drivers/transport.hpp"
#include "sim/markers/can_node.hpp"
#include "sim/simulated_bus.hpp"

namespace footlight::sim {

/// A classic CAN bus, bit by bit in time (ISO 11898-1): arbitration among all who want to send when the bus gets idle,
/// real stuffing, acknowledgement, error frames with automatic retransmission.
///
/// A disturbed frame ends at a random bit with 6 bits of error flag, 0..6 of its echo, 8 of delimiter and 3 of
/// inter-frame space; one that nobody acknowledges ends so at its acknowledge slot. A duplicated frame was received,
/// but its sender saw an error in the last bit of the end of frame and sends it again.
///
/// Error counters are not modelled; bus-off comes as a fault: the queue is lost, nothing is heard, and after 100 ms the
/// interface restarts, both told by error frames. A queue that does not move is stalled as in the transport.
class CanBus final : public SimulatedBus, public drivers::CanPort {
 public:
  /// The queue of a Linux CAN interface (txqueuelen).
  static constexpr std::size_t kQueue = 10;

  using SimulatedBus::SimulatedBus;

  std::size_t add(std::unique_ptr<SimulatedNode> node) override;
  void begin() override;
  void power_off(std::size_t slot) override;
  void power_on(std::size_t slot) override;
  void act(std::uint64_t token) override;

  drivers::SendStatus send(const drivers::CanFrame& frame) override;
  bool receive(drivers::CanFrame& frame) override;
  [[nodiscard]] Duration wire_time(const drivers::CanFrame& frame) const override;
  [[nodiscard]] std::size_t queued() const override {
    const bool one_is_leaving = now_sending_.speaker == kController && now_sending_.order == line_epoch_;
    return queue_.size() - (one_is_leaving ? 1 : 0);
  }
  [[nodiscard]] drivers::CanState state() const override;
  bool strike(LineFault fault) override;

 private:
  static constexpr int kNobody = -2;
  enum Kind : unsigned { kIdle, kEnd, kStatusDue, kHeartbeatDue, kLineBack };
  enum class Fate { good, repeated, disturbed, unacknowledged };

  /// What a node wants to send.
  struct Wish {
    drivers::CanFrame frame;
    std::uint64_t order;
    std::size_t slot;
    std::uint32_t epoch;
  };
  struct Transmission {
    drivers::CanFrame frame;
    int speaker = kNobody;
    std::uint32_t epoch = 0;
    Fate fate = Fate::good;
    std::uint64_t order = 0;
  };

  void line_back();
  void tell(std::uint16_t error_classes);
  [[nodiscard]] bool controller_may_speak() const;
  void want(std::size_t slot, const drivers::CanFrame& frame);
  void wake();
  void start_next();
  void draw_fate(int frame_bits);
  void end();
  void draw_losses(std::string& note);
  void deliver();
  void deliver_to(std::size_t slot);
  /// The node that was to hear a frame of the controller alone; kController for all of them.
  [[nodiscard]] int addressee() const;
  [[nodiscard]] bool cut_off(const Transmission& transmission) const;
  static bool yields(const Wish& a, const Wish& b);

  std::vector<std::unique_ptr<CanNode>> markers_;
  std::array<int, 128> slot_of_id_ = [] {
    std::array<int, 128> none{};
    none.fill(-1);
    return none;
  }();
  std::deque<drivers::CanFrame> queue_;     ///< of the controller; the first may be on the wire
  std::deque<drivers::CanFrame> received_;  ///< by the controller
  std::vector<Wish> wishes_;                ///< of the nodes; heap, the lowest identifier in front
  Transmission now_sending_;
  bool busy_ = false;               ///< a frame or the space after it
  bool woken_ = false;              ///< arbitration is scheduled
  std::array<bool, 128> missed_{};  ///< by slot: does not hear the frame that is ending
  bool controller_missed_ = false;
  std::size_t powered_ = 0;
  std::uint64_t order_ = 0;
  drivers::CanState line_ = drivers::CanState::active;  ///< active, bus_off or down
  std::uint64_t line_epoch_ = 0;                        ///< counts the times that the queue was lost
  Instant line_back_at_ = kStart;                       ///< until then it is so, or nothing leaves the queue
  Instant progress_ = kStart;  ///< when a frame of the controller left last, or began to wait alone
};

}  // namespace footlight::sim
