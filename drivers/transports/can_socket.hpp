// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "core/clock.hpp"
#include "core/result.hpp"
#include "drivers/transport.hpp"
#include "drivers/transports/file_descriptor.hpp"

namespace footlight::drivers {

/// Bits of a classic CAN data frame with an 11-bit identifier at worst stuffing, inter-frame space included.
///
///   47 + 8 n + floor((34 + 8 n - 1) / 4)
/// Source: K. W. Tindell, A. Burns, A. J. Wellings, "Calculating controller area network (CAN) message response times".
[[nodiscard]] constexpr int worst_can_bits(int data_bytes) {
  return 47 + 8 * data_bytes + (34 + 8 * data_bytes - 1) / 4;
}

/// A raw SocketCAN interface. What is still queued is reckoned from the frames' wire time, as the kernel does not say.
class CanSocket final : public CanPort {
 public:
  CanSocket(FileDescriptor socket, int bits_per_second);

  SendStatus send(const CanFrame& frame) override;
  bool receive(CanFrame& frame) override;
  [[nodiscard]] Duration wire_time(const CanFrame& frame) const override;
  [[nodiscard]] std::size_t queued() const override;
  [[nodiscard]] int poll_handle() const override { return socket_.get(); }

 private:
  FileDescriptor socket_;
  int bits_per_second_;
  SteadyClock clock_;
  Instant sent_by_{};  ///< all accepted frames have left by then
  bool bus_off_ = false;
};

/// @param interface as "can0", up and configured (`ip link set can0 up type can bitrate 500000 restart-ms 100`)
/// @param bits_per_second of the wire, for the reckoning; the interface's own setting is not changed
/// Errors: ErrorKind::device, with what the machine said.
[[nodiscard]] Result<std::unique_ptr<CanPort>> open_can(const std::string& interface, int bits_per_second);

}  // namespace footlight::drivers
