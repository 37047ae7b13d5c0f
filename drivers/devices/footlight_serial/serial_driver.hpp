// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "drivers/devices/footlight_serial/serial_frame.hpp"
#include "drivers/driver.hpp"
#include "drivers/leading.hpp"

namespace footlight::drivers {

/// Footlight serial markers (docs/wire-protocol.md, section 2) on an RS-485 line or a pseudo-terminal.
///
/// One frame at a time on the line: an operation is busy while an earlier frame is being sent or its answer awaited.
/// The time-out of an answer is its latest possible end (what is on the wire before it, 2 ms turnaround, its own
/// length) and a margin for the machine, which grows while answers come later than that and would collide with the next
/// request. Answers that do not fit what was asked are not ours and change nothing.
class SerialDriver final : public Driver {
 public:
  /// @param port borrowed for the life of the driver, as is the leadership; null: it leads without an epoch
  SerialDriver(ByteStream& port, const std::vector<NodeAddress>& nodes, std::uint8_t plan_byte,
               Leadership* leadership = nullptr);

  [[nodiscard]] std::string_view language() const override { return "footlight-serial"; }
  [[nodiscard]] Capabilities capabilities() const override {
    Capabilities can;
    can.contents = true;
    can.keeps_time = true;
    can.keeps_checks = true;
    return can;
  }
  [[nodiscard]] Duration preload_time(int channels) const override;
  [[nodiscard]] Duration status_time() const override;
  [[nodiscard]] Duration latch_time() const override;
  [[nodiscard]] Duration heartbeat_time() const override;
  [[nodiscard]] Duration upload_time() const override;
  [[nodiscard]] bool ready() const override { return !line_taken_; }

  void take_plan(std::uint8_t plan_byte) override;
  SendStatus start(Instant now) override;
  SendStatus preload(const NodeAddress& node, Sequence sequence, std::span<const LookIndex> looks,
                     Instant now) override;
  SendStatus latch(Sequence sequence, Instant now) override;
  SendStatus heartbeat(Duration show_time, Instant now) override;
  SendStatus ask(const NodeAddress& node, Instant now) override;
  SendStatus upload_look(LookIndex index, const Look& look, Instant now) override;
  SendStatus send_content(const NodeAddress& node, int channel, Sequence sequence, const WearableContent& content,
                          Instant now) override;
  [[nodiscard]] Duration content_time() const override;
  SendStatus sync_time(Duration show_time, double rate, Instant now) override;
  [[nodiscard]] Duration sync_time_time() const override;
  SendStatus tell_plan(std::uint32_t check, Instant now) override;
  SendStatus ask_kept(const NodeAddress& node, Instant now) override;
  [[nodiscard]] Duration kept_time() const override;
  [[nodiscard]] std::string_view refusal(Task /*task*/) const override { return {}; }
  /// Round 0 asks for a status, which is quick and tells that somebody is there; later rounds ask who.
  SendStatus probe(std::uint16_t address, unsigned round, Instant now) override;
  SendStatus identify(std::uint16_t address, bool on, Instant now) override;
  SendStatus set_address(std::uint16_t from, std::optional<std::uint32_t> unique_id, std::uint16_t to,
                         Instant now) override;
  SendStatus ask_health(std::uint16_t address, Instant now) override;
  SendStatus ask_clock(std::uint16_t address, Instant now) override;
  SendStatus ask_patch(std::uint16_t address, std::optional<std::uint32_t> patch, Instant now) override;
  Instant step(Instant now, EventSink& events) override;

 private:
  /// What an answer must be.
  struct Awaited {
    NodeAddress node;
    footlight_serial::Command command = footlight_serial::Command::status;
    Sequence sequence = 0;
    std::uint16_t crc = 0;
    int channel = 0;
    std::optional<Task> task{};  ///< a technician's: told as an answer
    bool several = false;        ///< more than one may answer, until the time is over
    bool heard = false;
    std::uint32_t dropped_before = 0;
  };

  [[nodiscard]] Duration wire_time(const footlight_serial::Frame& frame) const;
  SendStatus send(const footlight_serial::Frame& frame, std::optional<Awaited> awaited, std::size_t answer_bytes,
                  Instant now);
  void hear(const footlight_serial::Frame& frame, Instant now, EventSink& events);
  SendStatus serve(const footlight_serial::Frame& frame, Task task, std::size_t answer_bytes, Instant now);
  /// @return true when the answer was the last one
  bool tell_service(const footlight_serial::Frame& frame, EventSink& events);
  [[nodiscard]] std::vector<HealthValue> clock_values(const footlight_serial::NodeClock& clock) const;
  void give_up(EventSink& events);
  [[nodiscard]] Duration who_slot() const;
  void note_late(const footlight_serial::Frame& frame, Instant now);
  void tell_status(const NodeAddress& node, const footlight_serial::NodeStatus& status, Sequence shown,
                   EventSink& events);

  ByteStream& port_;
  Leadership* leadership_;  ///< null: it leads without an epoch
  unsigned beats_since_lead_ = 0;
  bool lead_due_ = false;                ///< before anything else: nodes do not know the plan byte yet
  std::atomic<std::uint8_t> plan_byte_;  ///< budgets are asked by other threads, too
  std::map<std::uint8_t, std::optional<std::uint16_t>> boots_;  ///< last known, by address
  footlight_serial::FrameReceiver receiver_;
  std::optional<Awaited> awaited_;
  std::optional<Awaited> given_up_;  ///< the last request whose answer did not come in time
  Duration margin_;                  ///< beyond the latest possible end of an answer
  Instant last_late_{};              ///< when an answer has come after it was given up
  struct ToldTime {
    Duration show_time{};
    Instant at;  ///< the frame's last byte
    double rate = 1;
  };
  std::optional<ToldTime> told_;
  Instant clock_asked_at_{};  ///< last byte of the question
  Instant line_free_{};       ///< the last byte sent has left by then; with `awaited_`, its answer is given up then
  bool line_taken_ = false;   ///< as of the last call
  bool down_ = false;
  bool down_told_ = false;
};

}  // namespace footlight::drivers
