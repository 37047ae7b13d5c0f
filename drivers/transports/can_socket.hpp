// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/clock.hpp"
#include "core/file_descriptor.hpp"
#include "core/result.hpp"
#include "drivers/transport.hpp"
#include "drivers/transports/can_in_flight.hpp"

namespace footlight::drivers {

/// Bits of a classic CAN data frame with an 11-bit identifier at worst stuffing, inter-frame space included.
///
///   47 + 8 n + floor((34 + 8 n - 1) / 4)
/// Source: K. W. Tindell, A. Burns, A. J. Wellings, "Calculating controller area network (CAN) message response times".
[[nodiscard]] constexpr int worst_can_bits(int data_bytes) {
  return 47 + 8 * data_bytes + (34 + 8 * data_bytes - 1) / 4;
}

/// A raw SocketCAN interface.
///
/// The kernel takes frames that never reach the wire: while an interface is without carrier `write` succeeds and the
/// frame is dropped, and `poll` says that a socket is writable when its interface's queue is full (ENOBUFS). So a frame
/// counts as queued until its echo has come back (CAN_RAW_RECV_OWN_MSGS, MSG_CONFIRM), and a queue that does not move
/// is `stalled`. Bus-off and restart come as error frames, the end of an interface as an error of the socket; an
/// interface that comes back, perhaps as a new one of the same name, is taken up within 100 ms of calls.
class CanSocket final : public CanPort {
 public:
  /// @param socket bound to `interface`  @param clock borrowed
  CanSocket(FileDescriptor socket, std::string interface, int bits_per_second, const Clock& clock,
            CanState state = CanState::active);

  SendStatus send(const CanFrame& frame) override;
  bool receive(CanFrame& frame) override;
  /// CAN FD frames are reckoned at the nominal bit rate throughout: an upper bound.
  [[nodiscard]] Duration wire_time(const CanFrame& frame) const override;
  [[nodiscard]] std::size_t queued() const override { return in_flight_.size(); }
  [[nodiscard]] CanState state() const override;
  [[nodiscard]] int poll_handle() const override { return socket_.get(); }
  [[nodiscard]] std::string trouble() const override;

 private:
  enum class Heard { nothing, frame, other };

  Heard read_one(CanFrame& frame);
  void take_error_frame(const CanFrame& frame);
  void go_down();
  void go_off();
  void reopen_when_due();

  FileDescriptor socket_;
  std::string interface_;
  int bits_per_second_;
  const Clock& clock_;
  CanInFlight in_flight_;
  CanState state_ = CanState::active;
  Instant try_again_{};        ///< down: to open the interface; bus-off: to send though nobody told of a restart
  std::uint32_t dropped_ = 0;  ///< frames that did not fit into our socket, as the kernel counts them
};

/// @param interface as "can0", up and configured (`ip link set can0 up type can bitrate 500000 restart-ms 100`)
/// @param bits_per_second of the wire, for the reckoning; the interface's own setting is not changed
/// Errors: ErrorKind::device, with what the machine said.
[[nodiscard]] Result<std::unique_ptr<CanPort>> open_can(const std::string& interface, int bits_per_second);

}  // namespace footlight::drivers
